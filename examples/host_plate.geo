// host_plate.geo - plate 1 m x 0.05 m under the water column of host_plate.c: gmsh -2 -format msh22 host_plate.geo
Point(1) = {0, -0.05, 0};
Point(2) = {1, -0.05, 0};
Point(3) = {1, 0, 0};
Point(4) = {0, 0, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 21;
Transfinite Curve {2, 4} = 3;
Transfinite Surface {1};
Recombine Surface {1};
Physical Curve("clamped", 1) = {2, 4};
Physical Curve("wet", 2) = {3};
Physical Surface("plate", 3) = {1};
