// A bar of 20 mm x 20 mm, bent to a quarter of a ring: gmsh -3 hook.geo -o hook.msh
Point(1) = {0.04, -0.01, 0};
Point(2) = {0.06, -0.01, 0};
Point(3) = {0.06, 0.01, 0};
Point(4) = {0.04, 0.01, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = 4; // three elements on each side
Transfinite Surface{1};
Recombine Surface{1}; // quadrilaterals, so that the volume has hexahedra
ring[] = Extrude {{0, 1, 0}, {0, 0, 0}, -Pi / 2} { Surface{1}; Layers{10}; Recombine; };
Physical Surface("root") = {1};
Physical Surface("tip") = {ring[0]};
Physical Volume("tissue") = {ring[1]};
