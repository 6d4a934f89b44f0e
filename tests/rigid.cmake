frond_test(test_rigid_motion SOURCES test_rigid_motion.c LABELS unit validation)
frond_test(test_rigid_shape SOURCES test_rigid_shape.c LABELS unit)
frond_test(test_rigid_mesh SOURCES test_rigid_mesh.c LABELS unit)
frond_test(test_rigid_joint SOURCES test_rigid_joint.c LABELS unit validation)
