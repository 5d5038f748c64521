#include "viewer/window/plan_overlay.h"

#include <vector>

#include "viewer/document/plan_handles.h"
#include "viewer/window/overlay.h"
#include "viewer/window/widgets.h"
#include "viewer/window/workbench.h"

namespace sgm::window {
namespace {

struct Pen {
    std::string_view layer;
    ImU32 color;
    float width;
};

const Pen& penOf(std::string_view layer) {
    static constexpr Pen pens[] = {
        {"highway", IM_COL32(255, 196, 92, 255), 2.0f}, {"street", IM_COL32(70, 74, 84, 230), 1.2f},
        {"crossing", IM_COL32(70, 74, 84, 150), 1.0f},  {"bridge", IM_COL32(255, 140, 110, 255), 2.0f},
        {"tunnel", IM_COL32(190, 140, 220, 255), 2.0f}, {"water", IM_COL32(90, 170, 240, 255), 1.5f},
        {"park", IM_COL32(110, 200, 110, 255), 1.5f},   {"", IM_COL32(120, 130, 150, 150), 1.0f}};
    for (const Pen& pen : pens)
        if (pen.layer == layer) return pen;
    return pens[std::size(pens) - 1];
}

}  // namespace

bool choosePlan(Workbench& bench) {
    if (!bench.session.plan()) return false;
    widgets::toggle(bench.report, "look.plan", "Plan", bench.view.look.plan,
                    "The plan of the town: it follows a slider before the buildings do");
    return true;
}

void drawPlan(Workbench& bench, const Projection& project, ImDrawList& list) {
    const auto plan = bench.view.look.plan ? bench.session.plan() : nullptr;
    if (!plan || !bench.tree()) return;
    const derive::Scope& ground = bench.tree()->shapes[document::widestShape(*bench.tree())].scope;
    const double height_m = ground.centre.y + ground.size.y / 2;
    std::vector<ImVec2> points;
    const auto drawRing = [&](const plan::Ring& ring, const Pen& pen) {
        points.clear();
        for (const plan::Vec2 p : ring.points) {
            const auto at = project({p.x, height_m, p.z});
            if (!at) return;
            points.push_back(*at);
        }
        list.AddPolyline(points.data(), static_cast<int>(points.size()), pen.color, true, pen.width);
    };
    for (const town::PlanFeature& feature : plan->features)
        for (const plan::Polygon& polygon : feature.area.polygons) {
            const Pen& pen = penOf(feature.layer);
            drawRing(polygon.outer, pen);
            for (const plan::Ring& court : polygon.courts) drawRing(court, pen);
        }
}

}  // namespace sgm::window
