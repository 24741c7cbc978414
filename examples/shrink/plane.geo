// Quarters of a shaft of radius 20 and of a ring from 20 to 40; mm
b = 20; c = 40; h = 7;
Point(1) = {0, 0, 0, h}; Point(2) = {b, 0, 0, h}; Point(3) = {0, b, 0, h};
Line(1) = {1, 2}; Circle(2) = {2, 1, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Point(11) = {b, 0, 0, h}; Point(12) = {c, 0, 0, h}; Point(13) = {0, c, 0, h}; Point(14) = {0, b, 0, h};
Line(11) = {11, 12}; Circle(12) = {12, 1, 13}; Line(13) = {13, 14}; Circle(14) = {14, 1, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Transfinite Curve {2} = 5; Transfinite Curve {14} = 6; // the nodes of the two sides do not match
Physical Curve("shaft_x") = {1}; Physical Curve("skin") = {2}; Physical Curve("shaft_y") = {3};
Physical Curve("ring_x") = {11}; Physical Curve("rim") = {12}; Physical Curve("ring_y") = {13}; Physical Curve("bore") = {14};
Physical Surface("shaft") = {1}; Physical Surface("ring") = {2};
