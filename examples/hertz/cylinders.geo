// Two half cylinders, radii 8 and 12, one on the other, cut at the plane of symmetry x = 0; mm
near = 0.5; far = 4;
Point(1) = {0, 0, 0, near}; Point(2) = {8, 8, 0, far}; Point(3) = {0, 8, 0, far};
Circle(1) = {1, 3, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Point(11) = {0, 0, 0, near}; Point(12) = {0, -12, 0, far}; Point(13) = {12, -12, 0, far};
Line(11) = {11, 12}; Line(12) = {12, 13}; Circle(13) = {13, 12, 11};
Curve Loop(2) = {11, 12, 13}; Plane Surface(2) = {2};
Physical Curve("arc") = {1}; Physical Curve("lid") = {2}; Physical Curve("middle") = {3};
Physical Curve("axis") = {11}; Physical Curve("base") = {12}; Physical Curve("face") = {13};
Physical Surface("small") = {1}; Physical Surface("large") = {2};
