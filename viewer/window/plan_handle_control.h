// Handles of plans in the view: drawn over it, and dragged over the ground.
// Enters: the workbench, a pointer. Leaves: edits of the document, one undo entry a drag. Assumes a frame of ImGui.
#pragma once

#include <imgui.h>

#include <optional>

#include "viewer/document/plan_handles.h"

namespace sgm::window {

class Workbench;
struct Projection;

class PlanHandleControl {
public:
    /// Draws the handles of what is selected and lets the pointer drag them; `hovered` says that the view has the
    /// pointer. True while the pointer is theirs, so that the camera stays.
    bool use(Workbench& bench, const Projection& project, ImDrawList& list, bool hovered);
    bool isDragging() const { return drag_.has_value(); }

private:
    struct Drag {
        size_t handle;
        Vec3d from;  ///< where the handle lay
        Vec3d grip;  ///< where the pointer took it, at the handle's height
        Vec3d to;    ///< where it is now
    };
    void renew(const Workbench& bench);
    void drag(Workbench& bench, const Projection& project);

    document::PlanHandles handles_;
    std::weak_ptr<const document::BuiltModel> shown_;  ///< the model and the selection that they are of
    derive::ShapeId selected_ = derive::none;
    std::optional<Drag> drag_;
};

}  // namespace sgm::window
