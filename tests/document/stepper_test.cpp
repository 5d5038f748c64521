// The Step panel: forward, back, picked shapes, and the way saved into the text.
#include "viewer/document/stepper.h"

#include <atomic>

#include "grammar/derive/print.h"
#include "tests/document/shown.h"
#include "viewer/document/step_job.h"

namespace sgm::document {
namespace {

constexpr const char* figure1 =
    "grammar 1\n"
    "start Figure -> cube : I0\n"
    "rule R0: I0 -> + sphere at +x : A\n"
    "rule R1: A -> cube : B\n"
    "rule R2: A -> + morph(cube, sphere, .5) at +y : DE\n"
    "rule R3: B -> + cylinder at +y : C\n"
    "rule R4: DE -> cone : F, torus : G\n"
    "derive left: R0 => R1 => R3 // as in the figure\n";

class Steps : public testing::Test {
protected:
    Stepper begun() {
        const auto model = shown(document);
        auto stepper = Stepper::begin(model->grammar, model->options);
        EXPECT_TRUE(stepper.ok());
        return *std::move(stepper);
    }
    static std::vector<StepRow> rowsOf(Stepper& stepper) { return stepper.view()->rows; }
    static std::vector<std::string> rulesOf(Stepper& stepper) {
        std::vector<std::string> names;
        for (const StepRow& row : rowsOf(stepper))
            for (const StepRule& rule : row.rules) names.push_back(rule.name);
        return names;
    }

    Document document{figure1};
};

TEST_F(Steps, GoForwardAndBack) {
    Stepper stepper = begun();
    EXPECT_EQ(rulesOf(stepper), std::vector<std::string>{"R0"});
    EXPECT_EQ(rowsOf(stepper)[0].path, "Figure/I0");
    ASSERT_TRUE(stepper.apply(rowsOf(stepper)[0].shape, rowsOf(stepper)[0].rules[0].rule).ok());
    EXPECT_EQ(rulesOf(stepper), (std::vector<std::string>{"R1", "R2"}));
    // A sphere that was picked in the view belongs to the live A.
    const derive::ShapeId a = rowsOf(stepper)[0].shape;
    const StepView view = *stepper.view();
    for (derive::ShapeId s = 0; s != derive::none; s = view.tree.next(s))
        EXPECT_TRUE(view.tree.labels[view.tree.shapes[s].label] != "sphere" || view.rowOf(s)->shape == a);
    EXPECT_FALSE(stepper.apply("R3").ok());
    ASSERT_TRUE(stepper.apply("R2").ok());
    ASSERT_TRUE(stepper.undo().ok());
    EXPECT_EQ(rulesOf(stepper), (std::vector<std::string>{"R1", "R2"}));
    ASSERT_TRUE(stepper.redo().ok());
    ASSERT_TRUE(stepper.applyRest().ok());
    EXPECT_TRUE(rulesOf(stepper).empty());
    EXPECT_EQ(*stepper.view()->way("w"), "derive w: R0 => R2 => R4\n");
}

TEST_F(Steps, SayWhichShapeClosedAJoint) {
    document = Document(
        "grammar 2\nstart A -> cube size 2 : B\nrule B -> + cube size 1 at +y : K\n"
        "rule K -> + sphere size 1 at -y\n");
    Stepper stepper = begun();
    EXPECT_EQ(rowsOf(stepper)[0].closed, "");
    ASSERT_TRUE(stepper.applyRest().ok());
    ASSERT_EQ(rowsOf(stepper).size(), 1u);
    EXPECT_TRUE(rowsOf(stepper)[0].rules.empty());
    EXPECT_EQ(rowsOf(stepper)[0].closed, "'-y' of 'A/B/K' is closed by 'A/B', made by the start (untitled.sgm:2)");
}

TEST_F(Steps, AreShownAndSaved) {
    Stepper stepper = begun();
    EXPECT_FALSE(stepper.save(*document.ast(), "mine").ok()) << "nothing was done";
    for (const char* rule : {"R0", "R2", "R4"}) ASSERT_TRUE(stepper.apply(rule).ok());
    const auto byHand = stepper.view()->derivation;

    Session session;
    ShowRequest request = requestOf(document);
    request.byHand = byHand;
    session.show(request);
    settle(session);
    ASSERT_TRUE(session.model());
    EXPECT_TRUE(session.model()->byHand);
    EXPECT_EQ(derive::toText(session.model()->model.derivation, true), derive::toText(*byHand, true));
    show(session, document);
    EXPECT_FALSE(session.model()->byHand);

    const auto edit = stepper.save(*document.ast(), "mine");
    ASSERT_TRUE(edit.ok()) << edit.error().message;
    ASSERT_TRUE(document.apply(*edit, "Save the way").ok());
    EXPECT_EQ(document.text(), std::string(figure1) + "derive mine: R0 => R2 => R4\n");
    Choice choice;
    choice.way = "mine";
    document.choose(choice, "Way");
    show(session, document);
    EXPECT_EQ(derive::toText(session.model()->model.derivation, false), derive::toText(*byHand, false));
    EXPECT_FALSE(stepper.save(*document.ast(), "mine").ok()) << "the text has changed";
    const auto kept = stepper.follow(session.model()->grammar, session.model()->options);
    ASSERT_TRUE(kept.ok());
    EXPECT_EQ(*kept, 3u);
    EXPECT_TRUE(stepper.save(*document.ast(), "mine")->empty()) << "it stands there already";
    EXPECT_FALSE(stepper.save(*document.ast(), "two words").ok());
}

TEST_F(Steps, FollowAChangedText) {
    Stepper stepper = begun();
    for (const char* rule : {"R0", "R2", "R4"}) ASSERT_TRUE(stepper.apply(rule).ok());
    document.type(replaced(figure1, "rule R4: DE", "rule R4: DF"));
    const auto changed = shown(document);
    const auto kept = stepper.follow(changed->grammar, changed->options);
    ASSERT_TRUE(kept.ok()) << kept.error().message;
    EXPECT_EQ(*kept, 2u);
    EXPECT_EQ(*stepper.view()->way("w"), "derive w: R0 => R2\n");
}

TEST_F(Steps, BeginWithAWay) {
    const auto model = shown(document);
    derive::Options options = model->options;
    options.derive = "left";
    auto stepper = Stepper::begin(model->grammar, options);
    ASSERT_TRUE(stepper.ok());
    EXPECT_EQ(*stepper->view()->way("w"), "derive w: R0 => R1 => R3\n");
    options.derive = "none";
    EXPECT_FALSE(Stepper::begin(model->grammar, options).ok());
}

/// Waits for what the job came to.
StepJob::Outcome taken(StepJob& job) {
    for (;;) {
        if (auto outcome = job.takeOutcome()) return *outcome;
        std::this_thread::yield();
    }
}

TEST_F(Steps, RunOnAThreadOfTheirOwn) {
    const auto model = shown(document);
    std::atomic<int> told = 0;
    StepJob job([&told] { ++told; });
    job.applyRest();
    EXPECT_FALSE(job.running()) << "nothing was begun";
    job.begin(model->grammar, model->options);
    EXPECT_FALSE(job.view());
    ASSERT_TRUE(taken(job).done.ok());
    EXPECT_EQ(told, 1);
    const auto first = job.view();
    ASSERT_TRUE(first);
    EXPECT_FALSE(first->canUndo || first->steps.ok());
    job.apply(first->rows[0].shape, first->rows[0].rules[0]);
    EXPECT_EQ(job.view(), first) << "as it was until the outcome is taken";
    EXPECT_EQ(taken(job).what, "Applied R0");
    job.applyRest();
    ASSERT_TRUE(taken(job).done.ok());
    job.undo();
    ASSERT_TRUE(taken(job).done.ok());
    EXPECT_EQ(*job.view()->way("w"), "derive w: R0\n");
    EXPECT_TRUE(job.view()->canRedo);
    job.save(document.ast(), "mine");
    const auto saved = taken(job);
    ASSERT_TRUE(saved.edit && saved.edit->ok());
    job.undo();
    job.end();
    EXPECT_FALSE(job.running() || job.view());
}

}  // namespace
}  // namespace sgm::document
