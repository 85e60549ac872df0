// A block of 2 x 2 x 3 hexahedra with groups of every kind. The other files of this folder were made of it:
//   gmsh -3 block.geo -format msh22 (or msh41; with -bin the binary ones) -o FILE
//   gmsh -3 block.geo -format msh41 -setnumber Mesh.SaveParametric 1 -o block-4.1-parametric.msh
//   gmsh -3 block.geo -format inp -o block.inp
Point(1) = {0, 0, 0};
Point(2) = {0.1, 0, 0};
Point(3) = {0.1, 0.1, 0};
Point(4) = {0, 0.1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = 3;
Transfinite Surface{1};
Recombine Surface{1};
out[] = Extrude {0, 0, 0.2} { Surface{1}; Layers{3}; Recombine; };
Physical Surface("foot") = {1};
Physical Surface("head plate") = {-out[0]};
Physical Curve("edge") = {1};
Physical Point("corner") = {3};
Physical Volume("tissue") = {out[1]};
Physical Volume("all") = {out[1]};
Physical Surface(77) = {out[2]};
