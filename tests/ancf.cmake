# Beams
frond_test(test_ancf_element SOURCES test_ancf_element.c LIBS frond_ancf LABELS unit TIMEOUT 60)
frond_test(test_ancf_damping SOURCES test_ancf_damping.c LIBS frond_ancf LABELS unit TIMEOUT 60)
frond_test(test_ancf_rest SOURCES test_ancf_rest.c LIBS frond_ancf LABELS validation TIMEOUT 60)
frond_test(test_ancf_ts SOURCES test_ancf_ts.c LABELS unit TIMEOUT 120)
frond_test(test_ancf_swing SOURCES test_ancf_swing.c LABELS validation TIMEOUT 300)
frond_test(test_ancf_validation SOURCES test_ancf_validation.c LABELS validation TIMEOUT 120)
frond_test(test_ancf_joint SOURCES test_ancf_joint.c LABELS unit TIMEOUT 120)
frond_test(test_ancf_blocktri SOURCES test_ancf_blocktri.c LIBS frond_ancf LABELS unit TIMEOUT 60)
