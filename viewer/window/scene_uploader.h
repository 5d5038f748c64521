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

#include "viewer/document/session.h"
#include "viewer/render/blocks_scene.h"
#include "viewer/render/field_scene.h"
#include "viewer/render/fog_scene.h"
#include "viewer/render/mesh_scene.h"
#include "viewer/window/window.h"

namespace sgm::window {

/// What it took to make a scene, seconds; compile is 0 where no shader was missing.
struct UploadTimes {
    double prepare = 0, compile = 0, upload = 0;
};
/// Something to be drawn, null where there is nothing new.
template <class Scene>
struct UploadResult {
    std::unique_ptr<Scene> scene;
    std::optional<render::Camera> camera;  ///< where it is best seen from; of fields, when asked for
    UploadTimes times;
};

class SceneUploader {
public:
    /// `notify` is called from the worker when `poll` would find something new.
    SceneUploader(std::unique_ptr<SharedContext> context, std::function<void()> notify);
    ~SceneUploader();
    SceneUploader(const SceneUploader&) = delete;
    SceneUploader& operator=(const SceneUploader&) = delete;

    /// Asks for the model's field; an earlier one that still waits is forgotten, one that runs may end first.
    void prepare(std::shared_ptr<const document::BuiltModel> model, bool withCamera);
    /// For a place inside it, as `inside` finds it.
    void lookInside(std::shared_ptr<const document::BuiltModel> model);
    /// For its fog with so many voxels along the longest side.
    void prepareFog(std::shared_ptr<const document::BuiltModel> model, int resolution);
    /// For a mesh of it, made on the GPU with so many cells along the longest side.
    void preview(std::shared_ptr<const document::BuiltModel> model, int resolution);
    /// For a mesh.
    void prepare(std::shared_ptr<const document::BuiltMesh> mesh);
    /// Frees what nobody looks at any more, for large fields and models take long.
    void deferDelete(std::shared_ptr<const void> deferred);
    /// Stops what runs and forgets what waits.
    void cancel();
    /// The same, and forgets what is ready: another document is to be shown.
    void forget();
    /// What has become ready since the last call.
    struct Update {
        UploadResult<render::FieldScene> field;
        UploadResult<render::FogScene> fog;
        UploadResult<render::MeshScene> mesh;
        bool meshIsPreview = false;
        std::optional<render::Camera> inside;
        std::string problem;  ///< why something can't be drawn, "" where nothing failed
    };
    Update poll();
    /// Something runs or waits.
    bool busy() const;
    /// A field runs or waits.
    bool makesField() const;
    /// What runs, and the share of it that is done, 0 … 1.
    std::string_view stage() const;
    double fraction() const;

private:
    struct Wanted {
        std::shared_ptr<const document::BuiltModel> model, fog, inside, preview;
        std::shared_ptr<const document::BuiltMesh> mesh;
        int fogResolution = 0, previewResolution = 0;
        bool withCamera = false;
        std::vector<std::shared_ptr<const void>> deferred;
        bool any() const { return model || fog || inside || mesh || preview; }
    };
    void ask(const std::function<void(Wanted&)>& how);
    void work();
    Status makeField(std::shared_ptr<const document::BuiltModel> model, bool withCamera, Progress& progress);
    Status makeFog(std::shared_ptr<const document::BuiltModel> model, int resolution, Progress& progress);
    Status makePreview(std::shared_ptr<const document::BuiltModel> model, int resolution, Progress& progress);
    Status ensureMeshPrograms(UploadTimes& times);
    Status findInside(const document::BuiltModel& model);
    Status makeMesh(std::shared_ptr<const document::BuiltMesh> meshed, Progress& progress);
    template <class Scene>
    void give(UploadResult<Scene> Update::*where, UploadResult<Scene> ready);

    std::unique_ptr<SharedContext> context_;
    std::function<void()> notify_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Wanted wanted_;
    Update update_;
    std::shared_ptr<Progress> running_;
    bool quit_ = false, makingField_ = false;

    // The worker's.
    std::shared_ptr<const render::FieldPrograms> fieldPrograms_;
    std::shared_ptr<const render::FogPrograms> fogPrograms_;
    std::shared_ptr<const render::MeshPrograms> meshPrograms_;
    std::shared_ptr<const render::BlockPrograms> blockPrograms_;

    std::thread worker_;
};

}  // namespace sgm::window
