#include "viewer/window/overlay.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

#include "grammar/derive/lift.h"
#include "viewer/window/style.h"

namespace sgm::window {
namespace {

constexpr size_t mostMarks = 4000;  // more would only be a cloud of dots

/// What holds places of the screen.
struct ScreenBox {
    ImVec2 low{FLT_MAX, FLT_MAX}, high{-FLT_MAX, -FLT_MAX};
    void add(ImVec2 at) {
        low = {std::min(low.x, at.x), std::min(low.y, at.y)};
        high = {std::max(high.x, at.x), std::max(high.y, at.y)};
    }
};

/// Of a shape's scope; bit 0 of the index is high x, bit 1 y, bit 2 z.
std::array<std::optional<ImVec2>, 8> cornersOf(const Workbench& bench, derive::ShapeId shape,
                                               const Projection& project) {
    const derive::Scope scope = derive::liftedScope(bench.shown()->model.derivation, shape);
    std::array<std::optional<ImVec2>, 8> corners;
    for (size_t i = 0; i < 8; ++i)
        corners[i] = project(scope.point({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0}));
    return corners;
}

}  // namespace

Projection::Projection(const render::Camera& camera, ImVec2 low, ImVec2 size)
    : view(viewOf(camera, std::max(1, static_cast<int>(size.x)), std::max(1, static_cast<int>(size.y)))),
      low(low),
      size(size) {}

std::optional<ImVec2> Projection::operator()(Vec3d p) const {
    const Vec3d v = p - view.eye;
    const double depth = dot(v, view.forward);
    if (depth < 1e-6) return std::nullopt;
    const double x = dot(v, view.right) / dot(view.right, view.right) / depth,
                 y = dot(v, view.up) / dot(view.up, view.up) / depth;
    if (std::abs(x) > 50 || std::abs(y) > 50) return std::nullopt;
    return ImVec2(low.x + static_cast<float>((x + 1) / 2) * size.x, low.y + static_cast<float>((1 - y) / 2) * size.y);
}

std::vector<ScreenJoint> screenJoints(const derive::ShapeTree& tree, const std::vector<derive::ShapeId>& shapes,
                                      const Projection& project) {
    std::vector<ScreenJoint> joints;
    for (const derive::ShapeId shape : shapes) {
        if (joints.size() > mostMarks) break;
        for (const document::JointMark& mark : document::jointMarks(tree, shape)) {
            // An open centre says nothing: every shape has one.
            if (mark.joint == derive::centreJoint && !mark.bonded) continue;
            if (const auto at = project(mark.point)) joints.push_back({mark, *at});
        }
    }
    return joints;
}

std::vector<derive::ShapeId> everyOwner(const derive::ShapeTree& tree) {
    std::vector<derive::ShapeId> owners;
    for (derive::ShapeId id = 0; id != derive::none && owners.size() < mostMarks; id = tree.next(id))
        if (tree.bonds().ownsBody(id)) owners.push_back(id);
    return owners;
}

const ScreenJoint* nearestJoint(const std::vector<ScreenJoint>& joints, ImVec2 place, float reach) {
    const ScreenJoint* nearest = nullptr;
    for (const ScreenJoint& joint : joints) {
        const float away = std::hypot(joint.at.x - place.x, joint.at.y - place.y);
        if (away >= reach) continue;
        reach = away;
        nearest = &joint;
    }
    return nearest;
}

void drawJoints(const std::vector<ScreenJoint>& joints, ImDrawList& list) {
    const float r = ImGui::GetFontSize() * 0.28f;
    for (const ScreenJoint& joint : joints) {
        const ImU32 color = joint.mark.toCentre ? tint::terminal : tint::good;
        list.AddCircleFilled(joint.at, r + 1.2f, IM_COL32(10, 12, 16, joint.mark.bonded ? 190 : 80));
        joint.mark.bonded ? list.AddCircleFilled(joint.at, r, color) : list.AddCircle(joint.at, r, color, 0, 1.6f);
    }
}

void drawBonds(const Workbench& bench, const Projection& project, ImDrawList& list) {
    const derive::ShapeTree* tree = bench.tree();
    const JointsShown shown = bench.view.look.joints;
    if (!tree || shown == JointsShown::None || (shown == JointsShown::Selected && bench.selected() == derive::none))
        return;
    for (const document::BondMark& bond : document::bondMarks(*tree, mostMarks)) {
        if (shown == JointsShown::Selected && bond.shapes[0] != bench.selected() && bond.shapes[1] != bench.selected())
            continue;
        const auto from = project(bond.from), at = project(bond.at), to = project(bond.to);
        const ImU32 color = bond.toCentre ? tint::terminal : tint::good;
        if (from && at) list.AddLine(*from, *at, (color & 0x00ffffff) | 0x90000000, 1.6f);
        if (at && to) list.AddLine(*at, *to, (color & 0x00ffffff) | 0x90000000, 1.6f);
    }
    drawJoints(
        screenJoints(*tree, shown == JointsShown::All ? everyOwner(*tree) : std::vector{bench.selected()}, project),
        list);
}

void drawScope(const Workbench& bench, derive::ShapeId shape, const Projection& project, ImDrawList& list) {
    const bool terminal = document::isTerminal(bench.shown()->model.derivation, shape);
    const auto corners = cornersOf(bench, shape, project);
    for (size_t i = 0; i < 8; ++i)
        for (const size_t bit : {1u, 2u, 4u}) {
            if (i & bit || !corners[i] || !corners[i | bit]) continue;
            list.AddLine(*corners[i], *corners[i | bit], IM_COL32(8, 10, 14, 150), 3.5f);
            list.AddLine(*corners[i], *corners[i | bit], terminal ? tint::terminal : tint::nonTerminal, 1.6f);
        }
}

void drawFace(const Workbench& bench, const Projection& project, ImDrawList& list, bool told) {
    if (!bench.view.face) return;
    ImVec2 corners[4];
    ScreenBox face, shape;
    for (size_t i = 0; i < 4; ++i) {
        const auto at = project(bench.view.face->corners[i]);
        if (!at) return;
        face.add(corners[i] = *at);
    }
    list.AddConvexPolyFilled(corners, 4, (tint::selected & 0x00ffffff) | 0x40000000);
    list.AddPolyline(corners, 4, tint::selected, ImDrawFlags_Closed, 2);
    if (!told) return;
    const std::string label = document::labelOf(*bench.view.face);
    const ImVec2 size = ImGui::CalcTextSize(label.c_str());
    ImVec2 low((face.low.x + face.high.x - size.x) / 2, (face.low.y + face.high.y - size.y) / 2);
    const bool hasRoom = face.high.x - face.low.x > size.x * 1.5f && face.high.y - face.low.y > size.y * 3;
    if (!hasRoom && bench.tree() && bench.selected() != derive::none) {
        for (const auto& corner : cornersOf(bench, bench.selected(), project))
            if (corner) shape.add(*corner);
        low.y = shape.low.y - size.y - 8;
        // At the picture's edge it gives way to the other side.
        if (low.y < project.low.y + 4) low.y = std::min(shape.high.y + 8, project.low.y + project.size.y - size.y - 4);
    }
    list.AddRectFilled({low.x - 5, low.y - 2}, {low.x + size.x + 5, low.y + size.y + 2}, IM_COL32(10, 12, 16, 190), 3);
    list.AddText(low, tint::text, label.c_str());
}

void drawAxes(const Projection& project, ImDrawList& list) {
    const float reach = ImGui::GetFontSize() * 1.7f;
    const ImVec2 centre(project.low.x + reach * 1.6f, project.low.y + project.size.y - reach * 1.6f);
    const Vec3d right = normalized(project.view.right), up = normalized(project.view.up);
    const struct {
        Vec3d axis;
        ImU32 color;
        const char* name;
    } axes[] = {{{1, 0, 0}, IM_COL32(214, 92, 84, 255), "x"},
                {{0, 1, 0}, IM_COL32(120, 178, 92, 255), "y"},
                {{0, 0, 1}, IM_COL32(90, 140, 220, 255), "z"}};
    list.AddCircleFilled(centre, reach * 1.35f, IM_COL32(20, 22, 26, 110), 32);
    for (const auto& a : axes) {
        const float x = static_cast<float>(dot(a.axis, right)) * reach,
                    y = static_cast<float>(-dot(a.axis, up)) * reach;
        const ImVec2 end(centre.x + x, centre.y + y);
        list.AddLine(centre, end, a.color, 2);
        const ImVec2 half = ImGui::CalcTextSize(a.name);
        list.AddText(ImVec2(centre.x + x * 1.22f - half.x / 2, centre.y + y * 1.22f - half.y / 2), a.color, a.name);
    }
}

}  // namespace sgm::window
