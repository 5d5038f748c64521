// What is drawn over the view: joints and bonds as in SG-M's figure 11, the selected shape's scope, the axes.
// Enters: a camera and a rectangle of the screen. Leaves: lines and dots in ImGui's draw list. Assumes a frame of
// ImGui.
#pragma once

#include <imgui.h>

#include <optional>

#include "viewer/document/shape_rows.h"
#include "viewer/render/scene.h"
#include "viewer/window/workbench.h"

namespace sgm::window {

/// From space to the screen.
struct Projection {
    render::View view;
    ImVec2 low, size;  ///< of the picture, screen pixels

    Projection(const render::Camera& camera, ImVec2 low, ImVec2 size);
    /// Nothing for what lies behind the eye.
    std::optional<ImVec2> operator()(Vec3d p) const;
};

/// A joint as it stands on the screen, for a pointer to find.
struct ScreenJoint {
    document::JointMark mark;
    ImVec2 at;
};
std::vector<ScreenJoint> screenJoints(const derive::ShapeTree& tree, const std::vector<derive::ShapeId>& shapes,
                                      const Projection& project);
/// The shapes that own a place in space: contents that fill one exactly share its joints.
std::vector<derive::ShapeId> everyOwner(const derive::ShapeTree& tree);
/// The joint within `reach` pixels of a place, or null.
const ScreenJoint* nearestJoint(const std::vector<ScreenJoint>& joints, ImVec2 place, float reach);
/// Red joins to a centre, green face to face; bonded ones filled.
void drawJoints(const std::vector<ScreenJoint>& joints, ImDrawList& list);
/// Joints and bonds as `look.joints` asks for.
void drawBonds(const Workbench& bench, const Projection& project, ImDrawList& list);
/// The edges of a shape's scope: red for a terminal, blue for a non-terminal, as in SG-M's figure 1.
void drawScope(const Workbench& bench, derive::ShapeId shape, const Projection& project, ImDrawList& list);
/// The selected face, and where `told` its words: on it where it has room for them, or else above the shape.
void drawFace(const Workbench& bench, const Projection& project, ImDrawList& list, bool told);
/// x, y and z in a corner.
void drawAxes(const Projection& project, ImDrawList& list);

}  // namespace sgm::window
