// What the panels show: rules, shapes, parameters, colours, export options.
#include <algorithm>

#include "modeler/core/packages.h"
#include "tests/document/shown.h"
#include "tests/scratch.h"
#include "viewer/document/colours.h"
#include "viewer/document/export_job.h"
#include "viewer/document/param_rows.h"
#include "viewer/document/report_rows.h"
#include "viewer/document/rule_rows.h"
#include "viewer/document/shape_rows.h"

namespace sgm::document {
namespace {

TEST(RuleRows, ShowTheRuleTree) {
    const syntax::Ast ast = parsed(tower);
    std::string text;
    for (const RuleRow& row : ruleRows(ast)) {
        text += std::string(row.depth * 2, ' ') + row.text + "\n";
        EXPECT_EQ(row.kind == RuleRow::Kind::Element || row.kind == RuleRow::Kind::Attribute, row.element != nullptr);
        EXPECT_EQ(row.rule == nullptr, row.start != nullptr);
    }
    EXPECT_EQ(text,
              "start Tower\n  cube : Storey\n    size (4, 1, 4)\n"
              "Up: Storey\n  repeat floors - 1\n  + cube : Storey\n    size (4 ~> 2, 1, 4)\n    at +y\n  finally\n    "
              "+ cone : Wing\n      on last\n      at +y\n"
              "Wing\n  when floors > 2\n  weight 2\n  cube\n  + sphere\n    at +x\n    shift (0, lean, 0)\n  - "
              "cylinder\n    size 50%\n    at +z\n    to centre\n  morph torus\n    by .3\n"
              "Wing\n  weight 1\n  cube\n  when bulge == round\n    + cone\n      at +y\n  sphere\n");
    const syntax::Ast split =
        parsed("grammar 1\nstart A -> split x { 1m: b | { ~2m: C with n = 3 }* | ~1: choose { 2: d | 1: nil } }\n");
    text.clear();
    for (const RuleRow& row : ruleRows(split)) text += std::string(row.depth * 2, ' ') + row.text + "\n";
    EXPECT_EQ(text,
              "start A\n  split x\n    1m:\n      b\n    { }*\n      ~2m:\n        C\n          with "
              "n = 3\n    ~1:\n      choose\n        2:\n          d\n        1:\n          nil\n")
        << "what only divides has no empty row";
    text.clear();
    for (const RuleRow& row : ruleRows(parsed("grammar 2\nstart A -> cube + split y { ~1: b }, split x { ~1: c }\n")))
        text += (row.first && row.sibling > 0 ? ", " : "") + row.text + "\n";
    EXPECT_EQ(text, "start A\ncube\n+ …\nsplit y\n~1:\nb\n, split x\n~1:\nc\n");
}

TEST(ReportRows, SumWithTheirUnits) {
    const auto model =
        shown(Document("grammar 2\nstart A -> cube size (4, 3, 5) report floors (20m2) + cube size (2, 3, 5) at +x "
                       "report floors (10m2) "
                       "report doors 2\n"));
    const auto rows = reportRows(model->model.derivation);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].name, "floors");
    EXPECT_EQ(rows[0].sum, "30m2");
    EXPECT_EQ(rows[0].details, "2 shapes, from 10m2 to 20m2");
    EXPECT_EQ(rows[1].sum, "2");
}

TEST(RuleRows, FindTheRowOfAPlace) {
    const syntax::Ast ast = parsed(tower);
    const auto rows = ruleRows(ast);
    const std::string text = tower;
    const auto at = [&](std::string_view word, size_t into) {
        return rows[rowAt(rows, static_cast<uint32_t>(text.find(word) + into))].text;
    };
    EXPECT_EQ(at("shift (0, lean", 9), "shift (0, lean, 0)");
    EXPECT_EQ(at("+ sphere", 3), "+ sphere");
    EXPECT_EQ(at("rule Up", 1), "Up: Storey");
    EXPECT_EQ(rowAt(rows, 0), rows.size());
}

TEST(ShapeRows, FilterAndFold) {
    const auto model = shown(Document(tower));
    const derive::Derivation& d = model->model.derivation;
    const auto all = shapeRows(d, {}, {});
    EXPECT_EQ(all.size(), d.tree.shapes.size());
    EXPECT_EQ(all[0].shape, 0u);
    EXPECT_EQ(labelOf(d, 0).name, "Tower");
    EXPECT_EQ(labelOf(d, 0).rule, "start");
    EXPECT_FALSE(labelOf(d, 0).terminal);

    Folded folded{d.tree.shapes[0].key};
    EXPECT_EQ(shapeRows(d, {}, folded).size(), 1u);
    EXPECT_FALSE(shapeRows(d, {}, folded)[0].open);

    const auto spheres = shapeRows(d, {"SPHERE", false}, folded);
    EXPECT_LT(spheres.size(), all.size());
    EXPECT_GT(std::count_if(spheres.begin(), spheres.end(), [](const ShapeRow& r) { return r.matches; }), 0);
    for (const ShapeRow& row : spheres) {
        const ShapeLabel label = labelOf(d, row.shape);
        EXPECT_EQ(row.matches, label.name.substr(0, 6) == "sphere");
        EXPECT_TRUE(row.shape == 0 || std::any_of(spheres.begin(), spheres.end(), [&](const ShapeRow& r) {
                        return r.shape == d.tree.shapes[row.shape].parent;
                    }));
    }
    size_t byRule = 0;
    for (const ShapeRow& row : shapeRows(d, {"Up", false}, {}))
        byRule += row.matches && labelOf(d, row.shape).rule.substr(0, 2) == "Up";
    EXPECT_GT(byRule, 1u);
    EXPECT_TRUE(shapeRows(d, {"nowhere", false}, {}).empty());

    reveal(d.tree, all.back().shape, folded);
    const auto revealed = shapeRows(d, {}, folded);
    EXPECT_TRUE(
        std::any_of(revealed.begin(), revealed.end(), [&](const ShapeRow& r) { return r.shape == all.back().shape; }));
}

TEST(ShapeRows, JointsAndBondsAsInFigure11) {
    const auto model =
        shown(Document("grammar 1\nstart A -> cube size 2 + cube size 2 at +x + sphere size 1 at +y to centre\n"));
    const derive::ShapeTree& tree = model->model.derivation.tree;
    const auto cube = tree.find("A/cube");
    ASSERT_NE(cube, derive::none);
    const auto joints = jointMarks(tree, cube);
    ASSERT_EQ(joints.size(), 7u);
    EXPECT_EQ(joints[0].name, "+x");
    EXPECT_TRUE(joints[0].bonded && !joints[0].toCentre) << "green and filled";
    EXPECT_EQ(joints[0].point, (Vec3d{1, 0, 0}));
    EXPECT_EQ(joints[0].direction, (Vec3d{1, 0, 0}));
    EXPECT_TRUE(joints[2].bonded && joints[2].toCentre) << "red and filled";
    EXPECT_FALSE(joints[1].bonded || joints[1].toCentre) << "green and open";
    EXPECT_TRUE(joints[6].toCentre && !joints[6].bonded);
    const auto bonds = bondMarks(tree);
    ASSERT_EQ(bonds.size(), 2u);
    EXPECT_EQ(bonds[0].at, (Vec3d{1, 0, 0}));
    EXPECT_EQ(bonds[0].to, (Vec3d{2, 0, 0}));
    EXPECT_FALSE(bonds[0].toCentre);
    EXPECT_TRUE(bonds[1].toCentre);
    EXPECT_EQ(bondMarks(tree, 1).size(), 1u);
    EXPECT_EQ(closedJoints(model->model.derivation, cube),
              "'+x' of 'A/cube' is closed by 'A/cube/cube', made by the start (untitled.sgm:2)");
    EXPECT_TRUE(isTerminal(model->model.derivation, cube));
}

constexpr const char* manyKinds =
    "grammar 2\n"
    "param n = 4 in 1..40 \"Number\" group Size key n\n"
    "param wide = 2m in 1m..9m \"Width\" group Size\n"
    "param bend = 10deg in 0deg..90deg\n"
    "param shift = (0, .25, .1) in 0..1.0\n"
    "param share = .5 in 0..1.0 key s\n"
    "param kind = flat of flat, steep, round key k\n"
    "param paint = #aabbcc\n"
    "param lit = true\n"
    "start A -> cube size (wide, n, 1 + share) turn bend color paint move shift when kind == flat and lit { + sphere "
    "at +y }\n"
    "style Big for A { n = 30 }\n";

TEST(ParamRows, HaveKindsUnitsAndRanges) {
    Document document(manyKinds);
    Choice choice;
    choice.locked = {"wide"};
    document.choose(choice, "Lock");
    const auto model = shown(document);
    const auto rows = paramRows(*model->grammar, model->options, document.choice());
    ASSERT_EQ(rows.size(), 8u);
    using Kind = ParamRow::Kind;
    const Kind kinds[] = {Kind::Integer, Kind::Real,   Kind::Real,  Kind::Real,
                          Kind::Real,    Kind::Choice, Kind::Color, Kind::Truth};
    const char* texts[] = {"4", "2m", "10deg", "(0, 0.25, 0.1)", "0.5", "flat", "#aabbcc", "true"};
    for (size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i].kind, kinds[i]) << rows[i].name;
        EXPECT_EQ(valueText(rows[i]), texts[i]) << rows[i].name;
        EXPECT_EQ(rows[i].locked, rows[i].name == "wide");
    }
    EXPECT_EQ(rows[0].label, "Number");
    EXPECT_EQ(rows[0].group, "Size");
    EXPECT_EQ(rows[0].key, 'n');
    EXPECT_EQ(rows[2].label, "bend");
    EXPECT_EQ(rows[2].unit, "deg");
    EXPECT_EQ(rows[2].hi, std::vector<double>{90});
    EXPECT_EQ(rows[3].lo, (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(rowOfKey(rows, 'k'), &rows[5]);
    EXPECT_EQ(rowOfKey(rows, 'z'), nullptr);
    EXPECT_EQ(stylesFor(*model->grammar, 0), std::vector<std::string>{"Big"});
    EXPECT_EQ(startsOf(*model->grammar), std::vector<std::string>{"A"});
}

TEST(ParamRows, ValuesGoBackToTheTextAndStayWhatTheyWere) {
    Document document(manyKinds);
    Session session;
    show(session, document);
    const auto set = [&](size_t i, auto change) {
        auto rows = paramRows(*session.model()->grammar, session.model()->options, document.choice());
        change(rows[i]);
        const auto edit = setParams(*document.ast(), document.choice(), {rows[i]});
        ASSERT_TRUE(edit.ok()) << edit.error().message;
        ASSERT_TRUE(document.apply(*edit, "Set").ok());
        show(session, document);
        ASSERT_TRUE(session.problems().empty()) << session.problems()[0].message << "\n" << document.text();
        const auto now = paramRows(*session.model()->grammar, session.model()->options, document.choice());
        EXPECT_EQ(now[i].kind, rows[i].kind);
        EXPECT_EQ(valueText(now[i]), valueText(rows[i]));
    };
    set(0, [](ParamRow& r) { r.number[0] = 17; });
    set(1, [](ParamRow& r) { r.number[0] = 3.14159265; });
    EXPECT_NE(document.text().find("wide = 3.142m in"), std::string::npos) << document.text();
    set(2, [](ParamRow& r) { r.number[0] = 90; });
    set(3, [](ParamRow& r) { r.number = {1, 1, 0}; });
    set(4, [](ParamRow& r) { r.number[0] = 1; });
    EXPECT_NE(document.text().find("share = 1.0 in"), std::string::npos) << document.text();
    set(5, [](ParamRow& r) { r.word = "round"; });
    set(6, [](ParamRow& r) { r.color = {1, 0, 0}; });
    set(7, [](ParamRow& r) { r.number[0] = 0; });
    Choice choice;
    choice.style = "Big";
    document.choose(choice, "Style");
    show(session, document);
    set(0, [](ParamRow& r) { r.number[0] = 31; });
    EXPECT_NE(document.text().find("style Big for A { n = 31 }"), std::string::npos);
}

TEST(ParamRows, StayRealWithoutAPointInTheRange) {
    ParamRow row;
    row.number = {1};
    row.lo = {0};
    row.hi = {1};
    EXPECT_EQ(valueText(row), "1.0");
    row.number = {0.30000001};
    EXPECT_EQ(valueText(row), "0.3");
    row.number = {7};
    EXPECT_EQ(valueText(row), "1.0") << "the range holds";
    row.number = {1, 0};
    row.lo = {0, 0}, row.hi = {2, 2};
    EXPECT_EQ(valueText(row), "(1.0, 0)");
}

TEST(ParamRows, HotkeysStepAndRerollsStayInRange) {
    const auto model = shown(Document(manyKinds));
    Choice choice;
    choice.locked = {"bend"};
    const auto rows = paramRows(*model->grammar, model->options, choice);
    EXPECT_EQ(stepped(rows[0], false).number[0], 5);
    EXPECT_EQ(stepped(rows[0], true).number[0], 3);
    EXPECT_EQ(stepped(rows[5], true).word, "round");
    EXPECT_EQ(stepped(rows[5], false).word, "steep");
    EXPECT_EQ(stepped(rows[7], false).number[0], 0);
    EXPECT_DOUBLE_EQ(stepped(rows[4], false).number[0], 0.55);
    ParamRow most = rows[0];
    for (int i = 0; i < 100; ++i) most = stepped(most, false);
    EXPECT_EQ(most.number[0], 40);

    const auto once = rerolled(rows, 1), again = rerolled(rows, 1), other = rerolled(rows, 2);
    bool differs = false;
    for (size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(valueText(once[i]), valueText(again[i]));
        differs = differs || valueText(once[i]) != valueText(other[i]);
        for (size_t k = 0; k < once[i].lo.size(); ++k)
            EXPECT_TRUE(once[i].lo[k] <= once[i].number[k] && once[i].number[k] <= once[i].hi[k]);
    }
    EXPECT_TRUE(differs);
    EXPECT_EQ(once[2].number, rows[2].number) << "locked";
    EXPECT_NE(once[0].number, rows[0].number);
}

TEST(Colours, SayWhatWordsAre) {
    const syntax::Ast ast =
        parsed("grammar 1\nparam n = 3 // x\nterminal wall color #aabbcc\nstart A -> cube size n : B, wall\n");
    const auto lines = colours(ast);
    ASSERT_EQ(lines.size(), 5u);
    using C = TextColour;
    const auto kinds = [&](size_t line) {
        std::vector<C> list;
        for (const Coloured& c : lines[line]) list.push_back(c.colour);
        return list;
    };
    EXPECT_EQ(kinds(1), (std::vector<C>{C::Keyword, C::Parameter, C::Sign, C::Number, C::Comment}));
    EXPECT_EQ(kinds(2), (std::vector<C>{C::Keyword, C::Terminal, C::Operation, C::Hex}));
    EXPECT_EQ(kinds(3), (std::vector<C>{C::Keyword, C::NonTerminal, C::Sign, C::Solid, C::Operation, C::Parameter,
                                        C::Sign, C::NonTerminal, C::Sign, C::Terminal}));
    EXPECT_EQ(lines[1][1], (Coloured{6, 7, C::Parameter}));
    EXPECT_TRUE(lines[4].empty());
}

TEST(Exports, ShowEveryOptionOfTheTable) {
    for (const exporter::Exporter& format : exporter::exporters()) {
        if (format.needs && !isBuiltWith(*format.needs)) continue;
        const auto rows = exportRows(format);
        ASSERT_EQ(rows.size(), format.options.size());
        for (const ExportRow& row : rows) {
            EXPECT_FALSE(row.name.empty() || row.doc.empty());
            EXPECT_TRUE(row.choices.empty() || std::count(row.choices.begin(), row.choices.end(), row.value) == 1);
            exporter::ExportOptions options{{row.name, row.value}};
            EXPECT_TRUE(exporter::checkOptions(format, options).ok());
        }
    }
}

TEST(Exports, WriteTheSolidTree) {
    const Scratch scratch;
    const auto outcome = [&](const std::string& body) {
        const auto model = shown(Document("grammar 1\nstart A -> " + body + "\n"));
        ExportJob job;
        EXPECT_TRUE(job.start(model, {.file = scratch / "a.csg.json", .options = {}}).ok());
        std::optional<Status> done;
        while (!(done = job.take())) std::this_thread::yield();
        return *done;
    };
    EXPECT_FALSE(outcome("cube size 2 + sphere size 1 blend .2m").ok());
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.csg.json"));
    EXPECT_TRUE(outcome("cube size 2 - sphere size 1").ok());
    EXPECT_GT(std::filesystem::file_size(scratch / "a.csg.json"), 500u);
}

TEST(Exports, WriteObjects) {
    const Scratch scratch;
    const auto model = shown(Document("grammar 1\nstart A -> cube size 2 : Wall\n"));
    const auto outcome = [&](const std::string& objects) {
        ExportJob job;
        EXPECT_TRUE(
            job.start(model, {.file = scratch / "a.gltf", .options = {}, .resolution = 16, .objects = objects}).ok());
        std::optional<Status> done;
        while (!(done = job.take())) std::this_thread::yield();
        return *done;
    };
    EXPECT_TRUE(outcome("Wall").ok());
    EXPECT_NE(contentOf(scratch / "a.gltf").find("\"Wall\""), std::string::npos);
    const Status unknown = outcome("Door");
    ASSERT_FALSE(unknown.ok());
    EXPECT_NE(unknown.error().message.find("no shape is called 'Door'"), std::string::npos);
}

TEST(Exports, WriteTheSolidsThatStay) {
    const Scratch scratch;
    const auto model = shown(Document("grammar 1\nstart A -> cube size 2 + cube size .2 at +x shift (1, 0, 0)\n"));
    const auto sizeOf = [&](const std::string& name, mesh::Keep keep) {
        ExportJob job;
        EXPECT_TRUE(job.start(model, {.file = scratch / name, .options = {}, .resolution = 64, .keep = keep}).ok());
        std::optional<Status> done;
        while (!(done = job.take())) std::this_thread::yield();
        EXPECT_TRUE(done->ok());
        return std::filesystem::file_size(scratch / name);
    };
    for (const std::string ending : {".ply", ".vdb"}) {
        if (ending == ".vdb" && !isBuiltWith(Package::OpenVdb)) continue;
        const auto all = sizeOf("all" + ending, mesh::Keep::All);
        EXPECT_LT(sizeOf("grounded" + ending, mesh::Keep::Grounded), all);
        EXPECT_EQ(sizeOf("largest" + ending, mesh::Keep::Largest), sizeOf("grounded" + ending, mesh::Keep::Grounded));
    }
}

TEST(Exports, WriteNothingOfNothing) {
    const Scratch scratch;
    const auto model = shown(Document("grammar 1\nstart Needle -> cube size (.01, 2, .01)\n"));
    ExportJob job;
    ASSERT_TRUE(job.start(model, {.file = scratch / "a.ply", .options = {}, .cell_m = .5}).ok());
    std::optional<Status> done;
    while (!(done = job.take())) std::this_thread::yield();
    EXPECT_EQ(done->error().kind, Error::Kind::Input);
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.ply"));
}

TEST(Exports, WriteFilesOrSayWhyNot) {
    const Scratch scratch;
    const auto model = shown(Document(tower));
    ExportJob job;
    const auto run = [&](const std::string& name, exporter::ExportOptions options) -> Status {
        const Status begun = job.start(model, {scratch / name, std::move(options), 24});
        if (!begun.ok()) return begun;
        for (;;) {
            if (auto done = job.take()) return *done;
            std::this_thread::yield();
        }
    };
    EXPECT_TRUE(run("a.glb", {{"uv", "none"}}).ok());
    EXPECT_GT(std::filesystem::file_size(scratch / "a.glb"), 1000u);
    EXPECT_EQ(run("a.vdb", {}).ok(), isBuiltWith(Package::OpenVdb));
    EXPECT_EQ(std::filesystem::exists(scratch / "a.vdb"), isBuiltWith(Package::OpenVdb));
    EXPECT_EQ(run("a.xyz", {}).error().kind, Error::Kind::Usage);
    EXPECT_EQ(run("a.glb", {{"up", "z"}}).error().kind, Error::Kind::Usage);
    EXPECT_EQ(run("none/a.glb", {}).error().kind, Error::Kind::Input);
    EXPECT_FALSE(job.start(nullptr, {scratch / "b.glb", {}}).ok());
    ASSERT_TRUE(job.start(model, {scratch / "c.stl", {}, 512}).ok());
    job.cancel();
    EXPECT_FALSE(job.start(model, {scratch / "d.stl", {}}).ok()) << "one at a time";
    std::optional<Status> done;
    while (!(done = job.take())) std::this_thread::yield();
    EXPECT_EQ(done->error().kind, Error::Kind::Cancelled);
    EXPECT_FALSE(std::filesystem::exists(scratch / "c.stl"));
}

}  // namespace
}  // namespace sgm::document
