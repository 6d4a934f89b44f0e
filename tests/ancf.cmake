# Beams
frond_test(test_ancf_element SOURCES test_ancf_element.c LIBS frond_ancf LABELS unit TIMEOUT 60)
