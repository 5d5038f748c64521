// A mesh without a section: nothing is cut away.
bool isCutAway(vec3 p) { return false; }
bool showsCut() { return false; }
