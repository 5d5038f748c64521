// The objects that `place` puts into a model: each derived, lowered and meshed once, and where it stands.
// Enters: a derived model. Leaves: a mesh::Scene, for files and pictures. Assumes that nothing but its inputs decides
// an object, so that objects may be made in any order and at the same time.
#pragma once

#include "grammar/pipeline/floating.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/model.h"
#include "grammar/syntax/source.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/scene.h"

namespace sgm::pipeline {

/// How finely objects are meshed, and what they may cost.
struct SceneRequest {
    int resolution = 128;  ///< cells along the longest side of each object
    double cell_m = 0;     ///< of every object, metres; > 0 wins over the resolution
    mesh::PolygonizeOptions meshing = {};
    MeshEdits edits = {};
    bool joinsBoxes = false;      ///< of each object, see lower::lower: what is missing isn't told by parts then
    bool seeksThinParts = false;  ///< look at the first object of each start for parts that its cells lack
    derive::Budget budget = {};  ///< of the derivation of each object; its shapes limit the places of the model as well
};

/// A scene, and what is to be said of its objects.
struct MadeScene {
    mesh::Scene scene;
    syntax::Diagnostics warnings;  ///< those of derive::warnings, each once, then floatingObjects
    std::vector<derive::Reported>
        reports;  ///< of objects at all places, by index in Grammar::reports; empty: no object
    std::vector<MeshWarning> meshWarnings;  ///< what the cells of objects lack, where that is sought
};

/// A mesh and whose its triangles are.
struct ObjectMesh {
    mesh::Mesh mesh;
    Provenance provenance;
    std::vector<MeshWarning> lacks;  ///< parts that the cells don't hold, where that is sought
};
/// Lowers, compiles, meshes and edits what one object derived to. Thin parts are looked for where it has a name.
/// Error::Input for one without surface at these cells.
Result<ObjectMesh> meshObject(derive::Derivation derivation, const SceneRequest& request, Context& context,
                              const std::string& name = {});

/// Derives, lowers and meshes every object of `model`, those that objects place among them, on `context.threads`
/// threads; stage "objects". Objects that differ by chance alone are one where chance decides nothing. Error::Input,
/// located, for an object that can't be built or holds itself; Error::Budget for too many places.
Result<MadeScene> makeScene(const Model& model, const SceneRequest& request, Context& context);

/// What makeScene would say of parts that the cells of objects lack and of objects that float, for pictures of the
/// field: meshes the first object of each start. Errors as of makeScene.
Result<std::vector<MeshWarning>> objectWarnings(const Model& model, const SceneRequest& request, Context& context);

/// Derives the objects of `derivation` and puts a copy of their shapes at every place, so that they are part of its
/// field; stage "objects". Then it holds no objects any more. Nothing for a derivation without objects. Error::Input as
/// of makeScene. Where the model would have more than `budget.shapes` shapes, Objects::Grafted is an Error::Budget, and
/// Objects::Sketched puts a box in the stead of each object.
Status graftObjects(derive::Derivation& derivation, Objects objects, const derive::Budget& budget, Context& context);

/// Derives and lowers the objects alone: the errors that `makeScene` would have before it meshes, or which objects
/// float.
Result<syntax::Diagnostics> tryObjects(const derive::Derivation& derivation, const derive::Budget& budget,
                                       Context& context);

}  // namespace sgm::pipeline
