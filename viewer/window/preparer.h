// Makes what the session gives ready for the GPU, beside the window: cells of fields, lists of meshes.
// Enters: the newest model and mesh. Leaves: prepared ones. Assumes that one thread (the window's) calls it, every
// frame `poll`.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "viewer/document/session.h"
#include "viewer/field_scene.h"
#include "viewer/mesh_scene.h"

namespace sgm::viewer {

struct ReadyField {
    std::shared_ptr<const Shown> of;
    std::shared_ptr<const PreparedField> field;
    double seconds = 0;  ///< that its cells took
};
struct ReadyMesh {
    std::shared_ptr<const Meshed> of;
    std::shared_ptr<const PreparedMesh> mesh;
};

class Preparer {
public:
    /// `wake` is called from the worker when `poll` would find something new.
    explicit Preparer(std::function<void()> wake);
    ~Preparer();
    Preparer(const Preparer&) = delete;
    Preparer& operator=(const Preparer&) = delete;

    /// Asks for this one; an earlier one that still waits is forgotten, one that runs may end first.
    void prepare(std::shared_ptr<const Shown> model);
    void prepare(std::shared_ptr<const Meshed> mesh);
    /// What has become ready since the last call; members are null where nothing has.
    struct Ready {
        ReadyField field;
        ReadyMesh mesh;
        std::string problem;  ///< why something can't be drawn, "" where nothing failed
    };
    Ready poll();
    /// Something runs or waits.
    bool busy() const;

private:
    void work();

    std::function<void()> wake_;
    mutable std::mutex mutex_;
    std::condition_variable wanted_;
    std::shared_ptr<const Shown> model_;
    std::shared_ptr<const Meshed> mesh_;
    Ready ready_;
    bool running_ = false, quit_ = false;
    Progress progress_;
    std::thread worker_;
};

}  // namespace sgm::viewer
