// Half of a slice of a cylinder of radius 500 on half of a layer, 1 thick and 40 wide, on half of a block 100 deep, cut at x = 0; mm
near = 1; far = 20; R = 500; w = 60;
Point(1) = {0, 0, 0, near}; Point(2) = {w, R - Sqrt(R^2 - w^2), 0, far / 2}; Point(3) = {w, w, 0, far}; Point(4) = {0, w, 0, far};
Point(5) = {0, R, 0};
Circle(1) = {1, 5, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(11) = {0, 0, 0, near}; Point(12) = {0, -1, 0, near}; Point(13) = {20, -1, 0, near}; Point(14) = {20, 0, 0, near};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Transfinite Curve {11, 13} = 2; Transfinite Curve {12, 14} = 21; Transfinite Surface {2};
Point(21) = {0, -1, 0, near}; Point(22) = {0, -101, 0, far}; Point(23) = {100, -101, 0, far}; Point(24) = {100, -1, 0, far};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21};
Curve Loop(3) = {21, 22, 23, 24}; Plane Surface(3) = {3};
Physical Curve("arc") = {1}; Physical Curve("outside") = {2}; Physical Curve("lid") = {3}; Physical Curve("middle") = {4};
Physical Curve("cut") = {11}; Physical Curve("underside") = {12}; Physical Curve("edge") = {13}; Physical Curve("surface") = {14};
Physical Curve("axis") = {21}; Physical Curve("base") = {22}; Physical Curve("end") = {23}; Physical Curve("face") = {24};
Physical Surface("roller") = {1}; Physical Surface("layer") = {2}; Physical Surface("substrate") = {3};
