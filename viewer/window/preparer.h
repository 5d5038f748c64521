// Makes what the session gives ready for the screen, beside the window: cells, fog and lists of meshes, their upload,
// and the shaders they need. Enters: the newest model and mesh. Leaves: scenes to be drawn. Assumes that one thread
// (the window's) calls it, every frame `poll`, and a GL context of its own that shares with that thread's.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "viewer/blocks_scene.h"
#include "viewer/document/session.h"
#include "viewer/field_scene.h"
#include "viewer/fog_scene.h"
#include "viewer/mesh_scene.h"
#include "viewer/window/window.h"

namespace sgm::viewer {

/// What it took to make a scene, seconds; compile is 0 where no shader was missing.
struct ReadyTimes {
    double prepare = 0, compile = 0, upload = 0;
};
/// Something to be drawn, null where there is nothing new.
template <class Scene>
struct Ready {
    std::unique_ptr<Scene> scene;
    std::optional<Camera> camera;  ///< where it is best seen from; of fields, when asked for
    ReadyTimes times;
};

class Preparer {
public:
    /// `wake` is called from the worker when `poll` would find something new.
    Preparer(std::unique_ptr<SharedContext> context, std::function<void()> wake);
    ~Preparer();
    Preparer(const Preparer&) = delete;
    Preparer& operator=(const Preparer&) = delete;

    /// Asks for the model's field; an earlier one that still waits is forgotten, one that runs may end first.
    void prepare(std::shared_ptr<const Shown> model, bool withCamera);
    /// For a place inside it, as `inside` finds it.
    void lookInside(std::shared_ptr<const Shown> model);
    /// For its fog with so many voxels along the longest side.
    void prepareFog(std::shared_ptr<const Shown> model, int resolution);
    /// For a mesh of it, made on the GPU with so many cells along the longest side.
    void preview(std::shared_ptr<const Shown> model, int resolution);
    /// For a mesh.
    void prepare(std::shared_ptr<const Meshed> mesh);
    /// Frees what nobody looks at any more, for large fields and models take long.
    void retire(std::shared_ptr<const void> retired);
    /// Stops what runs and forgets what waits.
    void cancel();
    /// What has become ready since the last call.
    struct News {
        Ready<FieldScene> field;
        Ready<FogScene> fog;
        Ready<MeshScene> mesh;
        bool meshIsPreview = false;
        std::optional<Camera> inside;
        std::string problem;  ///< why something can't be drawn, "" where nothing failed
    };
    News poll();
    /// Something runs or waits.
    bool busy() const;
    /// A field runs or waits.
    bool makesField() const;
    /// What runs, and the share of it that is done, 0 … 1.
    std::string_view stage() const;
    double fraction() const;

private:
    struct Wanted {
        std::shared_ptr<const Shown> model, fog, inside, preview;
        std::shared_ptr<const Meshed> mesh;
        int fogResolution = 0, previewResolution = 0;
        bool withCamera = false;
        std::vector<std::shared_ptr<const void>> retired;
        bool any() const { return model || fog || inside || mesh || preview; }
    };
    void ask(const std::function<void(Wanted&)>& how);
    void work();
    Status makeField(std::shared_ptr<const Shown> model, bool withCamera, Progress& progress);
    Status makeFog(std::shared_ptr<const Shown> model, int resolution, Progress& progress);
    Status makePreview(std::shared_ptr<const Shown> model, int resolution, Progress& progress);
    Status ensureMeshPrograms(ReadyTimes& times);
    Status findInside(const Shown& model);
    Status makeMesh(std::shared_ptr<const Meshed> meshed, Progress& progress);
    template <class Scene>
    void give(Ready<Scene> News::*where, Ready<Scene> ready);

    std::unique_ptr<SharedContext> context_;
    std::function<void()> wake_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Wanted wanted_;
    News news_;
    std::shared_ptr<Progress> running_;
    bool quit_ = false, makingField_ = false;

    // The worker's.
    std::shared_ptr<const FieldPrograms> fieldPrograms_;
    std::shared_ptr<const FogPrograms> fogPrograms_;
    std::shared_ptr<const MeshPrograms> meshPrograms_;
    std::shared_ptr<const BlockPrograms> blockPrograms_;

    std::thread worker_;
};

}  // namespace sgm::viewer
