// What the panels share: the document, what is computed of it, what is looked at and what is selected; and the verbs.
// Enters: user input. Leaves: a document that changes by edits alone. Assumes one thread (the window's) and a GL
// context.
#pragma once

#include <future>
#include <map>
#include <optional>
#include <string>

#include "viewer/document/document.h"
#include "viewer/document/edits.h"
#include "viewer/document/export_job.h"
#include "viewer/document/picking.h"
#include "viewer/document/recovery.h"
#include "viewer/document/selection.h"
#include "viewer/document/session.h"
#include "viewer/document/step_job.h"
#include "viewer/window/field_view.h"
#include "viewer/window/map_layer_view.h"
#include "viewer/window/mesh_view.h"
#include "viewer/window/orbit.h"
#include "viewer/window/plan_handle_control.h"
#include "viewer/window/report.h"
#include "viewer/window/scene_uploader.h"

namespace sgm::window {

enum class Pane { Field, Fog, Mesh, Split };
enum class NavigationPreset { Usual, Blender };
/// What the keys W A S D Q E do to the camera.
enum class Motion { Orbit, Fly, Walk };
enum class JointsShown { None, Selected, All };

/// How the model is looked at; not part of the document.
struct Look {
    Pane pane = Pane::Field;
    render::MeshStyle mesh;
    int sectionAxis = 0;        ///< 0 x, 1 y, 2 z
    float sectionShare = 0.5f;  ///< of the bounds, from low to high
    bool section = false;
    pipeline::Section plane() const { return {sectionAxis, true, static_cast<double>(sectionShare), true}; }
    int meshResolution = 128;  ///< cells along the longest side
    bool ground = true;
    bool plan = false;  ///< the plan of a town over the view
    JointsShown joints = JointsShown::Selected;
    Motion motion = Motion::Orbit;
    NavigationPreset navigation = NavigationPreset::Usual;
};

/// Something the user must decide before it goes on.
struct Question {
    std::string text;
    std::vector<std::pair<std::string, std::function<void()>>> answers;  ///< an empty function only closes it
};

/// The grammar is to be saved under a name that the user chooses.
struct Naming {
    std::function<void()> then;  ///< what goes on once it is saved; may be empty
};

/// Pictures from all around, one a turn of 360° / count.
struct Turntable {
    int next = 0, count = 36;
    double yaw = 0;      ///< of the first, radians
    std::string folder;  ///< a new one, for these pictures alone
};

/// What the pointer is over in the view.
struct Hover {
    Vec3f position;  ///< metres
    derive::ShapeId shape = derive::none;
    std::string text;  ///< "Cell · rule Cell · grotto.sgm:24"
    std::optional<derive::NamedFace> face;
};

/// What looks at the model, and how.
struct ModelView {
    FieldView field;
    MeshView mesh;
    Orbit orbit;
    MapLayerView mapLayer;
    PlanHandleControl planHandles;
    Look look;
    std::optional<Hover> hover;
    Orbit seenFrom;                         ///< the camera of the last frame
    std::optional<derive::NamedFace> face;  ///< of the selected shape, where the click was
    bool framed = false;                    ///< the camera has been set for this file

    bool wantsMesh() const { return look.pane == Pane::Mesh || look.pane == Pane::Split; }
    /// All that the window shows is whole.
    bool drawn() const { return (look.pane == Pane::Mesh || field.finished()) && (!wantsMesh() || mesh.finished()); }
};

/// What panels and bars tell each other and the user.
struct Panels {
    std::string notice;
    bool noticeIsProblem = false;
    bool fileIsNew = false;  ///< the document's file hasn't been written yet, since it began in the window
    std::optional<std::pair<uint32_t, uint32_t>> reveal;  ///< bytes of the text to show, taken by the Text panel
    bool showText = false;                                ///< the Text panel is to come to the front
    bool revealRow = false;                               ///< the selected row is to be seen, taken by the Rules panel
    std::string hotkeys;                                  ///< of the grammar's parameters: they go before the view's
    bool typing = false;                                  ///< the text takes keys
    std::optional<Question> question;
    std::optional<Naming> naming;  ///< "Save as" is open, or opens next
    bool leaving = false;          ///< the window may close
};

/// Pictures that were asked for.
struct Pictures {
    std::optional<Turntable> turntable;
    bool wanted = false;          ///< one
    std::future<Status> writing;  ///< of the last one, on a thread of its own; valid until its end is told
    std::string name;             ///< of its file
};

/// What is known of the last field and mesh shown.
struct RenderStatus {
    bool previewed = false;  ///< the mesh shown is the GPU's, of a model that is being dragged
    UploadTimes fieldTimes;  ///< that the last field took
    int compiles = 0;        ///< of shaders for fields, so far
};

class Workbench {
public:
    /// `shared` is a context for the worker that uploads.
    Workbench(Report& report, std::unique_ptr<SharedContext> shared, std::function<void()> notify);

    // --- The document ---
    /// With `mayBegin` a file that isn't there begins a new grammar of that name, and a notice says so.
    Status open(const std::filesystem::path& path, bool mayBegin = false);
    /// Nothing but a notice where the edit was refused. What it adds or moves is selected.
    void edit(const document::edits::Edit& edit, const std::string& label);
    void undo();
    void redo();
    /// Writes the document's file; asks for a name where it has none.
    void save(bool overwrite = false);
    /// Asks whether to go on with what a crash left behind of this document; where none is open, of any. Says so where
    /// it left something of another one.
    void offerAbandoned();
    /// Opens another file; wants confirmation where the current text isn't saved. `then` runs once it is open.
    void drop(const std::filesystem::path& path, const std::function<void()>& then = {});
    /// True when nothing is unsaved; else asks, and `leaving` tells later.
    bool mayClose();
    /// Takes what other programs changed, or asks. True when something has changed.
    bool lookAtFiles();
    /// Asks the session for what the document says now; cheap where nothing changed.
    void refresh();
    /// Takes over what the workers have finished. True when something is new.
    bool poll();
    /// Something is computed, or has been and waits for `poll`.
    bool busy() const { return !asked_.settled || working(); }

    /// Writes the shown model to a file on a thread of its own.
    void exportTo(document::ExportRequest request);

    // --- The selection ---
    /// A shape of the shown model, or none. The text that made it is revealed unless `quiet`.
    void select(derive::ShapeId shape, bool quiet = false);
    /// A shape of the derivation by hand. The model that has it may come later, or not at all while the text is wrong.
    void selectLive(derive::ShapeId shape);
    derive::ShapeId selected() const { return selection.shape(); }
    const document::BuiltModel* shown() const { return session.model().get(); }
    const derive::ShapeTree* tree() const { return shown() ? &shown()->model.derivation.tree : nullptr; }

    // --- The derivation by hand ---
    void beginSteps(const std::string& way);
    void endSteps();

    // --- The view ---
    void stepInside();
    /// The field shown will make room for another: not worth a finer picture.
    bool outdated() const {
        return uploader.makesField() || (session.busy() && session.revisions().attempted != document.revision());
    }
    /// Stops what runs; what is shown stays.
    void cancel();
    /// One sentence at the bottom of the window.
    void say(std::string text, bool problem = false);

    Report& report;
    document::Document document;
    document::Selection selection;
    document::Session session;
    SceneUploader uploader;
    document::ExportJob exporting;
    ModelView view;
    Panels panels;
    Pictures pictures;
    RenderStatus status;
    document::StepJob steps;  ///< has a view while the user derives by hand

private:
    /// The derivation that the user makes, shown instead of deriving.
    struct ByHand {
        std::shared_ptr<const derive::Derivation> derivation;
        uint64_t steppedAt = 0;  ///< the revision that the steps belong to
    };
    /// What the session and the uploader were last asked for.
    struct LastRequest {
        uint64_t revision = ~uint64_t(0);
        int resolution = 0;
        bool dragging = false;
        const derive::Derivation* byHand = nullptr;
        std::optional<pipeline::Section> section;
        std::shared_ptr<const document::BuiltModel> fog, prepared;
        bool otherModel = false;  ///< the session's model is that of the document before
        bool settled = false;     ///< all that was computed has been taken over
    };

    /// Goes over to another document; its model comes later, the field of the one before stays until then.
    void show(document::Document other);
    void resolveSelection();

    bool working() const { return session.busy() || uploader.busy() || steps.running(); }
    /// Leads the steps over to a new text.
    void followSteps();
    /// Shows what a step came to.
    void stepped(const document::StepJob::Outcome& outcome);

    std::function<void()> notify_;
    document::Recovery recovery_;
    ByHand byHand_;
    LastRequest asked_;
};

}  // namespace sgm::window
