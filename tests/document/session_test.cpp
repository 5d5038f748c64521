// The session: what is computed again, and what stays when a text is broken.
#include "viewer/document/session.h"

#include "grammar/pipeline/meshing.h"
#include "modeler/mesh/validate.h"
#include "tests/document/shown.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/scratch.h"

namespace sgm::document {
namespace {

constexpr const char* chain =
    "grammar 1\n"
    "param n = 4 in 1..40\n"
    "param wide = 2.5 in 1..9.0\n"
    "param paint = #aabbcc\n"
    "start A -> cube size (wide, 3, 3) color paint : B\n"
    "rule B repeat n -> + sphere size 1.5 at free(+x, +z) : B\n"
    "start Other -> cone\n"
    "style Wide { wide = 7.0 }\n"
    "derive none: B#1\n";

class Sessions : public testing::Test {
protected:
    void change(std::string_view from, std::string_view to) {
        document.type(replaced(document.text(), from, to));
        show(session, document);
    }
    bool stageRan(const char* name) const {
        for (const auto& [stage, seconds] : session.model()->stages)
            if (stage == name) return true;
        return false;
    }

    Document document{chain};
    Session session;
};

TEST_F(Sessions, ShowAModelAndTellWhatChanged) {
    show(session, document);
    ASSERT_TRUE(session.model());
    auto before = session.model();
    // True when the field is another; `looks` alike or not in any case.
    const auto changes = [&](bool looks) {
        const auto was = std::exchange(before, session.model());
        EXPECT_EQ(looksLike(*was, *before), looks);
        return was->fingerprint != before->fingerprint;
    };
    EXPECT_EQ(session.model()->model.derivation.steps.size(), 4u);
    EXPECT_EQ(session.revisions().attempted, document.revision());
    for (const char* stage : {"parse", "check", "derive", "lower", "compile"}) EXPECT_TRUE(stageRan(stage)) << stage;

    change("wide = 2.5", "wide = 2.6");
    EXPECT_TRUE(changes(false));
    change("wide = 2.6", "wide = 2.6 // the same");
    EXPECT_FALSE(changes(true));
    EXPECT_EQ(session.model()->grammar->sources[0]->text(), document.text()) << "its spans are of the present text";
    change("#aabbcc", "#ff0000");
    EXPECT_FALSE(changes(false)) << "colours aren't in the field";
    change("n = 4", "n = 5");
    EXPECT_TRUE(changes(false));
    change("+ sphere", "- sphere");
    EXPECT_TRUE(changes(false));
}

TEST_F(Sessions, BeginAtTheFirstStageThatChanged) {
    show(session, document);
    const auto first = session.model();
    show(session, document);
    EXPECT_EQ(session.model(), first) << "nothing changed";

    Choice choice = document.choice();
    choice.seed = 9;
    document.choose(choice, "Seed");
    show(session, document);
    EXPECT_NE(session.model(), first);
    EXPECT_EQ(session.model()->grammar, first->grammar) << "the text is the same";
    EXPECT_FALSE(stageRan("check"));
    EXPECT_TRUE(stageRan("derive"));
    EXPECT_EQ(session.model()->model.derivation.seed, 9u);

    const auto again = session.model();
    choice.locked = {"n"};
    document.choose(choice, "Lock");
    show(session, document);
    EXPECT_EQ(session.model(), again) << "a lock changes no model";
    EXPECT_EQ(session.revisions().attempted, document.revision());
}

TEST_F(Sessions, FollowStartStyleAndWay) {
    Choice choice;
    choice.style = "Wide";
    document.choose(choice, "Style");
    show(session, document);
    EXPECT_EQ(session.model()->model.derivation.tree.shapes[0].scope.size.x, 1.0);
    EXPECT_EQ(session.model()->options.params[1].num(), 7.0);
    choice.way = "none";
    document.choose(choice, "Way");
    show(session, document);
    EXPECT_EQ(session.model()->model.derivation.steps.size(), 4u);
    choice.start = "Other";
    choice.way = "";
    document.choose(choice, "Start");
    show(session, document);
    EXPECT_EQ(session.model()->model.derivation.tree.labels[0], "Other");
    // What is chosen may vanish from the text.
    change("start Other -> cone\n", "");
    EXPECT_EQ(session.model()->model.derivation.tree.labels[0], "A");
    ASSERT_EQ(session.problems().size(), 1u);
    EXPECT_EQ(session.problems()[0].severity, syntax::Severity::Warning);
    EXPECT_EQ(session.problems()[0].message, "there is no start 'Other' any more");
}

TEST_F(Sessions, WhatAClosedJointKeepsFromGrowingIsTold) {
    Document closed("grammar 1\nstart A -> cube : B\nrule B -> + cube size .5 at +x + sphere at +x\n");
    show(session, closed);
    ASSERT_EQ(session.problems().size(), 1u);
    EXPECT_EQ(session.problems()[0].severity, syntax::Severity::Warning);
    EXPECT_EQ(session.problems()[0].line, 3u);
    EXPECT_EQ(session.problems()[0].column, 32u);
    EXPECT_NE(session.problems()[0].message.find("is closed by"), std::string::npos);
}

TEST_F(Sessions, ABrokenTextKeepsTheLastModel) {
    show(session, document);
    const auto good = session.model();
    change("rule B repeat n ->", "rule B repeat ->");
    EXPECT_EQ(session.model(), good);
    EXPECT_EQ(session.revisions().attempted, document.revision());
    ASSERT_FALSE(session.problems().empty());
    EXPECT_EQ(session.problems()[0].line, 6u);

    change("rule B repeat ->", "rule B repeat m ->");  // reads well, means nothing
    EXPECT_EQ(session.model(), good);
    ASSERT_FALSE(session.problems().empty());
    EXPECT_EQ(session.problems()[0].line, 6u);
    EXPECT_EQ(session.problems()[0].column, 15u);

    change("repeat m", "repeat n");
    EXPECT_TRUE(session.problems().empty());
    EXPECT_NE(session.model(), good);
    const auto better = session.model();
    change("size 1.5 at", "size (wide - 5m) at");  // shows only while deriving
    EXPECT_EQ(session.model(), better);
    ASSERT_EQ(session.problems().size(), 1u);
    EXPECT_EQ(session.problems()[0].line, 6u) << session.problems()[0].message;
    EXPECT_EQ(session.problems()[0].file, "untitled.sgm");
}

TEST_F(Sessions, BudgetsEndInProblems) {
    ShowRequest request = requestOf(document);
    request.budget.shapes = 5;
    session.show(request);
    settle(session);
    EXPECT_FALSE(session.model());
    ASSERT_FALSE(session.problems().empty());
    EXPECT_NE(session.problems().back().message.find("budget of 5 shapes"), std::string::npos);
}

TEST_F(Sessions, TheNewestRequestCounts) {
    for (int n = 1; n <= 30; ++n) {
        document.type(replaced(document.text(), n == 1 ? "n = 4 in" : "n = " + std::to_string(n - 1) + " in",
                               "n = " + std::to_string(n) + " in"));
        session.show(requestOf(document));
    }
    settle(session);
    EXPECT_EQ(session.model()->revision, document.revision());
    EXPECT_EQ(session.model()->model.derivation.steps.size(), 30u);
}

TEST_F(Sessions, MeshWhenAskedAndKeepWhatStays) {
    ShowRequest request = requestOf(document);
    request.meshResolution = 40;
    session.show(request);
    settle(session);
    ASSERT_TRUE(session.mesh());
    const auto first = session.mesh();
    EXPECT_EQ(first->of, session.model());
    EXPECT_GT(mesh::measure(*first->mesh).triangles, 100u);
    change("#aabbcc", "#ff0000");
    EXPECT_EQ(session.mesh(), first) << "nobody asked";
    request = requestOf(document);
    request.meshResolution = 40;
    session.show(request);
    settle(session);
    EXPECT_EQ(session.mesh()->of, session.model());
    EXPECT_EQ(session.mesh()->blocksMade, 0u);
    EXPECT_EQ(session.mesh()->mesh->triangleCount(), first->mesh->triangleCount());
    change("n = 4", "n = 5");
    request = requestOf(document);
    request.meshResolution = 40;
    session.show(request);
    settle(session);
    EXPECT_EQ(session.mesh()->grid.cell_m, first->grid.cell_m) << "the lattice stays where it can";
}

TEST_F(Sessions, ProblemsOfTheMeshFollowIt) {
    Document floating;
    floating.type(
        "grammar 1\nstart A -> cube size (20, .5, 20) : Base\n"
        "rule Base -> + cube size (1, 3, 1) at +y move (0, .4, 0)\n");
    ShowRequest request = requestOf(floating);
    request.meshResolution = 48;
    session.show(request);
    settle(session);
    const auto told = [&] {
        return std::ranges::count_if(session.problems(), [](const Problem& p) {
            return p.line == 3 && p.message.find("a gap of 0.4 m lies between its") != std::string::npos;
        });
    };
    EXPECT_EQ(told(), 1);
}

TEST_F(Sessions, ASectionOpensTheMeshAndNotTheModel) {
    ShowRequest request = requestOf(document);
    request.meshResolution = 40;
    session.show(request);
    settle(session);
    ASSERT_TRUE(session.mesh());
    const Box3f whole = session.mesh()->mesh->bounds();
    request.section = pipeline::Section{0, true, .5, true};
    session.show(request);
    settle(session);
    const Box3f& model = session.model()->model.lowered->field.bounds;
    EXPECT_NEAR(session.mesh()->mesh->bounds().hi.x, (model.lo.x + model.hi.x) / 2, 1e-3);
    EXPECT_NEAR(session.mesh()->mesh->bounds().lo.x, whole.lo.x, 1e-3);
    request.section.reset();
    session.show(request);
    settle(session);
    EXPECT_NEAR(session.mesh()->mesh->bounds().hi.x, whole.hi.x, 1e-3);
}

class HeldSliders : public Sessions {
protected:
    /// A dragged slider goes from one text to another.
    void drag(std::string_view from, std::string_view to) {
        const TextEdit edit = difference(document.text(), replaced(document.text(), from, to));
        ASSERT_TRUE(document.apply(edit, "Drag").ok());
        show(session, document);
    }
    /// The same model as that of a window which is opened on this text now.
    void expectAsOpened() const {
        Document fresh(document.text());
        fresh.choose(document.choice(), "");
        const auto opened = shown(fresh);
        EXPECT_TRUE(looksLike(*session.model(), *opened));
        const pipeline::Model &ours = session.model()->model, &theirs = opened->model;
        EXPECT_EQ(ours.lowered->shapeOf, theirs.lowered->shapeOf);
        const auto &shapes = ours.derivation.tree.shapes, &others = theirs.derivation.tree.shapes;
        EXPECT_TRUE(std::equal(shapes.begin(), shapes.end(), others.begin(), others.end(),
                               [](const derive::Shape& a, const derive::Shape& b) {
                                   return std::tie(a.key, a.scope, a.material, a.live, a.op) ==
                                          std::tie(b.key, b.scope, b.material, b.live, b.op);
                               }));
        EXPECT_EQ(bytesOf(ours), bytesOf(theirs));
    }
    static std::vector<unsigned char> bytesOf(const pipeline::Model& model) {
        const Box3f& bounds = model.lowered->field.bounds;
        pipeline::Context context{nullptr, 1};
        const auto made = pipeline::makeMesh(model, mesh::gridFor(bounds, mesh::cellFor(bounds, 24)), {}, context);
        EXPECT_TRUE(made.ok());
        return mesh::bytesOf(made->mesh);
    }
};

TEST_F(HeldSliders, DeriveOnlyWhatTheyReach) {
    document = Document(
        "grammar 1\nparam wide = 2.5 in 1..9.0\nstart A -> cube size 3 + cone size 1.5 at -x + sphere size wide at +x "
        "+ cone at +y\n");
    show(session, document);
    const auto taken = session.model();
    document.beginDrag();
    show(session, document);
    EXPECT_EQ(session.model(), taken) << "nothing has moved yet";
    for (const auto& [from, to] :
         {std::pair{"wide = 2.5", "wide = 2.75"}, {"wide = 2.75", "wide = 3.0"}, {"wide = 3.0", "wide = 8.25"}}) {
        drag(from, to);
        EXPECT_TRUE(session.model()->held);
        EXPECT_FALSE(stageRan("check"));
        EXPECT_EQ(session.model()->grammar, taken->grammar);
        EXPECT_EQ(session.model()->shapesMade, 1u) << "of " << session.model()->model.derivation.tree.shapes.size();
        expectAsOpened();
    }
    const auto held = session.model();
    EXPECT_NE(held->fingerprint, taken->fingerprint);
    document.endDrag();
    show(session, document);
    EXPECT_FALSE(session.model()->held);
    EXPECT_EQ(session.model()->shapesMade, 5u);
    EXPECT_EQ(session.model()->fingerprint, held->fingerprint);
    EXPECT_EQ(session.model()->grammar->sources[0]->text(), document.text()) << "its spans are of the present text";
    expectAsOpened();
}

TEST_F(HeldSliders, FollowShapesThatComeAndGoAndStyles) {
    document.beginDrag();
    show(session, document);
    for (const auto& [from, to] : {std::pair{"n = 4", "n = 7"}, {"n = 7", "n = 6"}}) {
        drag(from, to);
        EXPECT_TRUE(session.model()->held);
        expectAsOpened();
    }
    document.endDrag();
    Choice choice = document.choice();
    choice.style = "Wide";
    document.choose(choice, "Style");
    show(session, document);
    document.beginDrag();
    drag("wide = 7.0 }", "wide = 6.5 }");
    EXPECT_TRUE(session.model()->held);
    EXPECT_EQ(session.model()->options.params[1].num(), 6.5);
    expectAsOpened();
}

TEST_F(HeldSliders, AnythingElseIsBuiltFromTheText) {
    show(session, document);
    document.beginDrag();
    drag("+ sphere", "- sphere");  // no slider's doing
    EXPECT_FALSE(session.model()->held);
    expectAsOpened();
    drag("wide = 2.5", "wide = 12.0");  // beyond its range
    EXPECT_FALSE(session.model()->held);
    ASSERT_FALSE(session.problems().empty());
    EXPECT_EQ(session.problems()[0].line, 3u);
    drag("wide = 12.0", "wide = 4.0");
    ASSERT_EQ(session.problems().size(), 1u);
    EXPECT_EQ(session.problems()[0].message, "this cuts nothing: it lies beside 'B'");
    expectAsOpened();
}

TEST(LongSessions, CanBeCancelledAndOvertaken) {
    Document document(
        "grammar 1\nparam n = 200000 in 1..200000\nstart A -> cube : B\nrule B repeat n -> + cube at +x : B\n");
    Document brief("grammar 1\nstart A -> cube\n");
    Session session;
    show(session, brief);
    const auto before = session.model();
    const auto begin = [&] {
        session.show(requestOf(document));
        while (session.stage() != std::string_view("derive")) std::this_thread::yield();
    };
    begin();
    session.cancel();
    settle(session);
    EXPECT_EQ(session.model(), before);
    ASSERT_EQ(session.problems().size(), 1u);
    EXPECT_NE(session.problems()[0].message.find("cancelled"), std::string::npos);
    begin();
    ShowRequest request = requestOf(brief);
    request.revision = 99;
    session.show(request);
    settle(session);
    EXPECT_EQ(session.revisions().attempted, 99u);
    EXPECT_EQ(session.model()->model.derivation.steps.size(), 0u);
    EXPECT_TRUE(session.problems().empty());
    begin();  // and may go while it works
}

TEST(UsedFiles, AreReadAgainWhenTheyChange) {
    const Scratch scratch;
    scratch.write("part.sgm", "grammar 1\nparam n = 2 in 1..9\nrule B repeat n -> + cube at +x : B\n");
    const auto path = scratch.write("main.sgm", "grammar 1\nuse \"part.sgm\"\nstart A -> cube : B\n");
    const Document document = *Document::open(path);
    Session session;
    show(session, document);
    ASSERT_TRUE(session.model());
    EXPECT_EQ(session.model()->model.derivation.steps.size(), 2u);
    EXPECT_FALSE(session.usedFilesChanged());
    scratch.write("part.sgm", "grammar 1\nparam n = 5 in 1..9\nrule B repeat n -> + cube at +x : B\n");
    std::filesystem::last_write_time(scratch / "part.sgm",
                                     std::filesystem::file_time_type::clock::now() + std::chrono::seconds(2));
    EXPECT_TRUE(session.usedFilesChanged());
    show(session, document);
    EXPECT_EQ(session.model()->model.derivation.steps.size(), 5u);
    EXPECT_FALSE(session.usedFilesChanged());
    // Broken and repaired again, the text of the document never changing.
    scratch.write("part.sgm", "grammar 1\nrule B repeat -> cube\n");
    std::filesystem::last_write_time(scratch / "part.sgm",
                                     std::filesystem::file_time_type::clock::now() + std::chrono::seconds(4));
    EXPECT_TRUE(session.usedFilesChanged());
    show(session, document);
    EXPECT_EQ(session.model()->model.derivation.steps.size(), 5u);
    ASSERT_FALSE(session.problems().empty());
    EXPECT_EQ(session.problems()[0].file, (scratch / "part.sgm").string());
}

TEST(Problems, TellPlacesOfLaterErrors) {
    const Problem p = problemOf({Error::Kind::Budget, "a/b:c.sgm:12:7: the budget of 5 shapes is spent: at 'A'"});
    EXPECT_EQ(p.file, "a/b:c.sgm");
    EXPECT_EQ(p.line, 12u);
    EXPECT_EQ(p.column, 7u);
    EXPECT_EQ(p.message, "the budget of 5 shapes is spent: at 'A'");
    EXPECT_EQ(problemOf({Error::Kind::Input, "nothing: no place"}).message, "nothing: no place");
    EXPECT_EQ(problemOf({Error::Kind::Input, "nothing: no place"}).line, 0u);
}

}  // namespace
}  // namespace sgm::document
