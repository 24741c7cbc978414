// [-1,1]^2 without [0,1]x[-1,0], and a block on its top
h = 0.5;
Point(1) = {-1, -1, 0, h}; Point(2) = {0, -1, 0, h}; Point(3) = {0, 0, 0, h}; Point(4) = {1, 0, 0, h}; Point(5) = {1, 1, 0, h};
Point(6) = {-1, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {1};
Point(11) = {-1, 1, 0, h}; Point(12) = {1, 1, 0, h}; Point(13) = {1, 2, 0, h}; Point(14) = {-1, 2, 0, h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Physical Curve("bottom") = {1}; Physical Curve("flanks") = {2, 3}; Physical Curve("right") = {4}; Physical Curve("top") = {5};
Physical Curve("left") = {6};
Physical Curve("underside") = {11}; Physical Curve("end") = {12}; Physical Curve("lid") = {13}; Physical Curve("back") = {14};
Physical Surface("ell") = {1}; Physical Surface("block") = {2};
