// Half of a cylinder of radius 50 on half of a block, both cut at the plane of symmetry x = 0; mm
near = 4; far = 20;
Point(1) = {0, 0, 0, near}; Point(2) = {50, 50, 0, far}; Point(3) = {0, 50, 0, far};
Circle(1) = {1, 3, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Point(11) = {0, 0, 0, near}; Point(12) = {0, -200, 0, 2 * far}; Point(13) = {100, -200, 0, 2 * far}; Point(14) = {100, 0, 0, far};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Physical Curve("arc") = {1}; Physical Curve("lid") = {2}; Physical Curve("middle") = {3};
Physical Curve("axis") = {11}; Physical Curve("base") = {12}; Physical Curve("end") = {13}; Physical Curve("face") = {14};
Physical Surface("roller") = {1}; Physical Surface("block") = {2};
