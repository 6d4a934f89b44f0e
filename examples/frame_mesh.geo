// A portal frame, one physical group for each beam: gmsh -1 -format msh22 frame_mesh.geo
Point(1) = {0, 0, 0};
Point(2) = {0, 0, 1};
Point(3) = {1.5, 0, 1};
Point(4) = {1.5, 0, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Transfinite Curve {1, 2, 3} = 5;
Physical Curve("left", 1) = {1};
Physical Curve("top", 2) = {2};
Physical Curve("right", 3) = {3};
