// Handles of plans: where they stand and what dragging them writes.
#include "viewer/document/plan_handles.h"

#include <set>

#include "tests/document/shown.h"

namespace sgm::document {
namespace {

struct Handles {
    Document document;
    std::shared_ptr<const BuiltModel> model;
    PlanHandles handles;

    explicit Handles(const std::string& text, const char* path = nullptr)
        : document("grammar 2\n" + text + "\n"),
          model(shown(document)),
          handles(
              PlanHandles::of(document, *model, path ? model->model.derivation.tree.find(path) : derive::ShapeId{0})) {}

    const PlanHandle& called(const std::string& name) const {
        for (const PlanHandle& h : handles.all())
            if (h.name == name) return h;
        ADD_FAILURE() << "no handle is called " << name;
        return handles.all().at(0);
    }
    /// The text after a handle was moved, without its first line.
    std::string moved(const std::string& name, Vec3d by, double step_m = .1) {
        const auto edit =
            handles.move(static_cast<size_t>(&called(name) - handles.all().data()), called(name).at + by, step_m);
        if (!edit.ok()) return edit.error().message;
        const std::string text = applied(document.text(), *edit);
        return text.substr(text.find('\n') + 1);
    }
};

TEST(PlanHandles, CornersOfAnOutlineComeToThePointer) {
    Handles h("start A -> footprint outline((0, 0), (8m, 0), (8, 600cm), (0, 6)) extrude 3m block", "A/block");
    ASSERT_EQ(h.handles.all().size(), 8u) << "four corners, four sides";
    EXPECT_EQ(h.called("corner 3").at, (Vec3d{4, -.5, 3}));
    EXPECT_EQ(h.moved("corner 3", {2, 0, 1}),
              "start A -> footprint outline((0, 0), (8m, 0), (12, 800cm), (0, 6)) extrude 3m block\n")
        << "the plan stands about its middle, so a corner under the pointer is twice as far out";
    EXPECT_EQ(h.moved("side 2", {1, 0, 5}),
              "start A -> footprint outline((0, 0), (10m, 0), (10, 600cm), (0, 6)) extrude 3m block\n")
        << "along its normal alone";
}

TEST(PlanHandles, SharesStayShares) {
    Handles h("start A -> size (10m, 3m, 10m) footprint outline((0%, 0%), (100%, 0%), (50%, 100%)) block", "A/block");
    EXPECT_EQ(h.moved("corner 3", {1, 0, -2}),
              "start A -> size (10m, 3m, 10m) footprint outline((0%, 0%), (100%, 0%), (60%, 80%)) block\n");
}

TEST(PlanHandles, SidesOfDrawnPlansMoveTheirNumbers) {
    Handles h("start A -> footprint ell(16m, 12, 5, wingZ: 6) extrude 3m block", "A/block");
    std::set<std::string> texts;
    for (const PlanHandle& side : h.handles.all()) {
        EXPECT_EQ(side.kind, PlanHandle::Kind::Side);
        const Vec3d along = side.ends[1] - side.ends[0];
        const Vec3d normal = normalized(Vec3d{along.z, 0, -along.x});
        texts.insert(h.moved(side.name, normal));
    }
    EXPECT_EQ(h.handles.all().size(), 6u);
    const auto has = [&](const char* plan) {
        return texts.contains(std::string("start A -> footprint ") + plan + " extrude 3m block\n");
    };
    EXPECT_TRUE(has("ell(18m, 12, 5, wingZ: 6)")) << "half of a width's change is at either side";
    EXPECT_TRUE(has("ell(16m, 14, 5, wingZ: 6)"));
    EXPECT_TRUE(has("ell(16m, 12, 6, wingZ: 6)"));
    EXPECT_TRUE(has("ell(16m, 12, 5, wingZ: 7)"));
    EXPECT_NE(h.moved("side 1", {0, 0, 40}), h.document.text()) << "a plan without room is refused in words";
}

TEST(PlanHandles, AreThoseOfTheNearestShapeWithAWrittenPlan) {
    const char* text = "start A -> footprint rect(8, 6) extrude 6m split y { 3m: Part | ~1: Part }\nrule Part -> block";
    EXPECT_EQ(Handles(text, "A/Part").handles.all().size(), 4u);
    EXPECT_TRUE(Handles("param w = 8m in 1m..9m\nstart A -> footprint rect(w, 6) extrude 3m block", "A/block")
                    .handles.all()
                    .empty())
        << "what a parameter says has its slider";
    EXPECT_TRUE(Handles("start A -> footprint rect(8, 6) offset 1m extrude 3m block", "A/block").handles.all().empty())
        << "what stands is not what was drawn";
    EXPECT_TRUE(Handles("start A -> cube").handles.all().empty());
}

TEST(PlanHandles, ATownHasItsSeedsAndBumps) {
    Handles h(
        "map old = bump((-50m, 20m), 60m)\nroads Net { pull = old from = (10m, 0m) }\nterminal lawn\n"
        "start T -> size (400m, 4m, 400m) network Net { ground: lawn }");
    EXPECT_EQ(h.called("from").at, (Vec3d{10, 2, 0}));
    EXPECT_NE(h.moved("old", {25, 0, -5}).find("bump((-25m, 15m), 60m)"), std::string::npos);
    EXPECT_NE(h.moved("from", {7.26, 0, 1}).find("from = (17.3m, 1m)"), std::string::npos);
}

}  // namespace
}  // namespace sgm::document
