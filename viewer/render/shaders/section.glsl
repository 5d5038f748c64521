// A mesh cut open by a plane: what lies beyond is left out, and where its inside is seen there is the cut.
uniform vec3 sectionNormal;
uniform float sectionOffset;
bool isCutAway(vec3 p) { return dot(sectionNormal, p) > sectionOffset; }
bool showsCut() { return !gl_FrontFacing; }
