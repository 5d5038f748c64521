// What the window shows of a document, kept up to date on a worker: text → Grammar → Derivation → Field → Tape (→
// Mesh). Enters: requests, the newest counts. Leaves: immutable models, problems, times. Assumes that one thread (the
// window's) calls it, every frame `poll`. Stages run again from the first that changed. A text with problems leaves the
// last good model standing; so does a request that was cancelled.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "grammar/lower/thin_parts.h"
#include "grammar/pipeline/files.h"
#include "grammar/pipeline/live_edit.h"
#include "grammar/pipeline/model.h"
#include "grammar/pipeline/section.h"
#include "grammar/rules/check.h"
#include "modeler/eval/fingerprint.h"
#include "modeler/mesh/rebuild.h"
#include "viewer/document/document.h"
#include "viewer/document/problems.h"

namespace sgm::document {

/// A good model. Immutable; shapes point into sources that `grammar` holds.
struct BuiltModel {
    uint64_t revision = 0;  ///< of the document it was made from
    std::shared_ptr<const rules::Grammar> grammar;
    derive::Options options;
    pipeline::Model model;
    bool byHand = false;  ///< its derivation came from the Step panel
    bool held = false;  ///< follows a slider that is dragged: `grammar`, and with it every span, is of the text before
    size_t shapesMade = 0;          ///< derived anew; the others were kept from the model before
    eval::Fingerprint fingerprint;  ///< of the tape: the same for two models, the same surface, bit for bit
    pipeline::Stages stages;        ///< seconds of what ran: parse, check, derive, lower, compile
};
/// Both are the same to the eye: surface and materials.
bool looksLike(const BuiltModel& a, const BuiltModel& b);

/// Its mesh, which comes later.
struct BuiltMesh {
    std::shared_ptr<const BuiltModel> of;
    mesh::Grid grid;
    std::shared_ptr<const mesh::Mesh> mesh;
    mesh::Counts counts;
    size_t blocksMade = 0, blocksKept = 0;
    pipeline::Stages stages;                        ///< subdivide, sample, polygonize
    std::optional<pipeline::Section> section = {};  ///< it is cut open there
};

/// What to show.
struct ShowRequest {
    std::shared_ptr<const syntax::Ast> ast;  ///< of Document
    syntax::Diagnostics syntaxProblems;      ///< the parser's word on it
    double parseSeconds = 0;                 ///< for the report of times
    Choice choice;
    uint64_t revision = 0;
    /// A slider is dragged: only what its value reaches is derived again. The text that it leaves is shown without
    /// this.
    bool dragging = false;
    /// Set by the Step panel: shown instead of deriving.
    std::shared_ptr<const derive::Derivation> byHand;
    /// Cells along the longest side of the model's bounds; 0: no mesh is wanted.
    int meshResolution = 0;
    std::optional<pipeline::Section> section = {};  ///< the mesh is cut open there
    derive::Budget budget;
};
/// The request that shows a document as it stands.
ShowRequest requestOf(const Document& document);

class Session {
public:
    /// `notify` is called from the worker when `poll` would find something new (glfwPostEmptyEvent).
    explicit Session(std::function<void()> notify = nullptr, rules::Loader loader = pipeline::fileLoader());
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Asks for a model. A request that still waits is forgotten; one that runs may end first, so that a slider that is
    /// dragged shows a frame now and then, unless it only meshes or has run for longer than a second.
    void show(ShowRequest request);
    /// Stops what runs and forgets what waits.
    void cancel();
    /// Another document is to be shown: the mesh goes, with what the worker keeps to make the next one of the same
    /// document faster. The model stays until there is another.
    void forgetMesh();
    /// Takes over what the worker has finished. True when model, mesh or problems are new.
    bool poll();

    /// The last good model, or null. Changes in `poll` alone, as all below.
    const std::shared_ptr<const BuiltModel>& model() const { return model_; }
    /// The mesh of a model (see `of`: perhaps of an earlier one), or null.
    const std::shared_ptr<const BuiltMesh>& mesh() const { return mesh_; }
    /// Of the last request that was tried: the parser's, the checker's and what went wrong later.
    const std::vector<Problem>& problems() const { return problems_; }
    /// Revisions of the document.
    struct Revisions {
        uint64_t attempted = 0;  ///< that `problems` speaks of
        uint64_t modelled = 0;   ///< that `model` is of; a text with errors gives none
    };
    const Revisions& revisions() const { return revisions_; }
    /// The plan of the newest town, which is there before its model while a slider is dragged; null where there is
    /// none.
    std::shared_ptr<const town::TownPlan> plan() const;

    /// Something runs or waits.
    bool busy() const;
    /// What runs, for the Progress panel: a stage's name and the share of it that is done, 0 … 1.
    std::string_view stage() const;
    double fraction() const;

    /// True when a file that the grammar uses has changed on disk since it was read: ask for the model again.
    bool usedFilesChanged() const;
    /// Those files.
    std::vector<std::filesystem::path> usedFiles() const;

private:
    struct UsedFile {
        std::filesystem::path path;
        std::filesystem::file_time_type time;
    };
    /// What an attempt gives, taken over by `poll`. Null: as before.
    struct Update {
        std::shared_ptr<const BuiltModel> model;
        std::shared_ptr<const BuiltMesh> mesh;
        std::shared_ptr<const town::TownPlan> plan;
        std::optional<std::vector<Problem>> problems;
        std::optional<std::vector<UsedFile>> used;
        std::optional<uint64_t> modelled;
        uint64_t attempted = 0;
    };

    /// What the window and the worker share.
    struct Queue {
        mutable std::mutex mutex;
        std::condition_variable wanted;
        std::optional<ShowRequest> pending;
        std::shared_ptr<Progress> running;  ///< of the request that runs, or null
        bool meshing = false, quit = false;
        bool forgetsMesh = false;  ///< the worker has yet to let go of its mesh
        Stopwatch since;           ///< the running request began
        Update update;
        bool fresh = false;
        std::vector<std::shared_ptr<const void>>
            deferred;  ///< what the window let go: large trees are freed by the worker

        /// Whether what runs is of no use any more.
        bool isSuperseded() const {
            const std::lock_guard lock(mutex);
            return pending || quit;
        }
    };
    /// Problems that the worker found, by what they are of.
    struct Found {
        std::vector<Problem> check;
        std::vector<Problem> derived;  ///< warnings of the derivation that was last made anew
        std::vector<Problem> model;    ///< what was last published of the model
        std::vector<Problem> mesh;     ///< warnings of the mesh that was last made at rest
    };
    /// The worker's last products, to begin from the first stage that changed.
    struct Last {
        std::shared_ptr<const syntax::Ast> ast;
        std::shared_ptr<const rules::Grammar> grammar;
        Found problems;
        std::vector<UsedFile> usedByCheck;
        std::optional<pipeline::LiveEdit> liveEdit;        ///< while a slider is held
        std::optional<pipeline::ValueChange> valueChange;  ///< of the request that it follows
        std::shared_ptr<const BuiltModel> shown;
        std::shared_ptr<const derive::Derivation> handShown;
        std::shared_ptr<const BuiltMesh> meshed;
        int meshResolution = 0;
        /// Of `meshed`, once its cells are halved around thin parts.
        std::optional<std::vector<lower::ThinPart>> missing;
        bool isMeshFinished = false;  ///< and its warnings are known
        mesh::Rebuild rebuild{mesh::PolygonizeOptions{.surface = mesh::Surface::Crisp}};

        /// No file that the grammar uses has changed since it was checked.
        bool isAsChecked() const;
        void forgetMesh();
    };

    void work();
    void attempt(const ShowRequest& request, Progress& progress);
    void giveUp(const ShowRequest& request, const Error& error);
    bool follows(const ShowRequest& request);
    bool checked(const ShowRequest& request, pipeline::Context& context, std::vector<Problem>& problems);
    Result<std::shared_ptr<const BuiltModel>> followed(const ShowRequest& request, std::vector<Problem>& problems,
                                                       Progress& progress);
    Result<std::shared_ptr<const BuiltModel>> made(const ShowRequest& request, pipeline::Context& context,
                                                   std::vector<Problem>& problems);
    void sketchPlan(const std::shared_ptr<const rules::Grammar>& grammar, derive::Options options, Progress& progress);
    void meshIt(const ShowRequest& request, Progress& progress);
    void finishMesh(Progress& progress);
    void meshCutOpen(const ShowRequest& request, Progress& progress);
    void publish(Update update);

    std::function<void()> notify_;
    rules::Loader loader_;

    // The window's.
    std::shared_ptr<const BuiltModel> model_;
    std::shared_ptr<const BuiltMesh> mesh_;
    std::shared_ptr<const town::TownPlan> plan_;  ///< newer than the model's, or null
    std::vector<Problem> problems_;
    std::vector<UsedFile> used_;
    Revisions revisions_;

    Queue queue_;
    Last last_;

    std::thread worker_;
};

}  // namespace sgm::document
