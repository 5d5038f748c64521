// Bonds are made when somebody asks, and are those that making them shape by shape gives.
#include "grammar/derive/bond_maker.h"

#include <array>
#include <filesystem>
#include <map>

#include "grammar/derive/bonds_in_planes.h"
#include "grammar/derive/incremental_derivation.h"
#include "grammar/derive/joints.h"
#include "grammar/derive/session.h"
#include "grammar/pipeline/load.h"
#include "tests/derive/same.h"

namespace sgm::derive {
namespace {

using namespace testing_;

/// Two joints that are bonded.
using Pair = std::array<uint32_t, 4>;

/// The bonds of a tree by their definition: what placed each newcomer, then every face of a place of its own with the
/// newest one that looks at it, where neither is closed.
class Definition {
public:
    explicit Definition(const ShapeTree& tree) : tree_(tree), place_(tree.shapes.size()) {
        size_t mate = 0;
        for (ShapeId id = 0; id < tree.shapes.size(); ++id) {
            const Shape& s = tree.shapes[id];
            const bool shares = s.parent != none && s.parent != 0 && s.op == rules::Operator::None &&
                                s.scope == tree.shapes[s.parent].scope;
            place_[id] = shares ? place_[s.parent] : id;
            for (; mate < tree.mates.size() && tree.mates[mate].newcomer == id; ++mate) place(tree.mates[mate]);
            if (!shares && !s.meetsNobody) meet(id);
        }
    }
    const std::vector<Pair>& bonds() const { return bonds_; }

private:
    /// Joints of faces are those of the place, declared ones the shape's own.
    std::pair<ShapeId, uint32_t> at(ShapeId id, uint32_t joint) const {
        return {joint < firstNamedJoint ? place_[id] : id, joint};
    }
    void close(ShapeId a, uint32_t ja, ShapeId b, uint32_t jb) {
        bonds_.push_back({a, ja, b, jb});
        const bool directed = tree_.joint(a, ja).direction != Vec3d{} && tree_.joint(b, jb).direction != Vec3d{};
        if (directed) closed_[at(a, ja)] = closed_[at(b, jb)] = true;
    }
    void place(const Mate& m) { close(m.host, m.ours, m.newcomer, m.theirs); }
    void meet(ShapeId id) {
        for (uint32_t j = 0; j < tree_.jointCount(id); ++j) {
            const Joint joint = tree_.joint(id, j);
            if (joint.direction == Vec3d{}) continue;
            const auto newest = newestFacing(joint);
            stood_.emplace(joint.point.x, std::pair(id, j));
            if (!newest || closed_.contains(at(id, j)) || closed_.contains(at(newest->first, newest->second))) continue;
            if (place_[newest->first] != place_[id]) close(newest->first, newest->second, id, j);
        }
    }
    std::optional<std::pair<ShapeId, uint32_t>> newestFacing(const Joint& joint) const {
        std::optional<std::pair<ShapeId, uint32_t>> newest;
        const auto end = stood_.upper_bound(joint.point.x + 2 * jointTolerance_m);
        for (auto e = stood_.lower_bound(joint.point.x - 2 * jointTolerance_m); e != end; ++e)
            if (faceEachOther(joint, tree_.joint(e->second.first, e->second.second)))
                if (!newest || *newest < e->second) newest = e->second;
        return newest;
    }

    const ShapeTree& tree_;
    std::vector<ShapeId> place_;  ///< by shape: the first one that stood there
    std::multimap<double, std::pair<ShapeId, uint32_t>> stood_;
    std::map<std::pair<ShapeId, uint32_t>, bool> closed_;
    std::vector<Pair> bonds_;
};

std::vector<Pair> pairsOf(const Bonds& bonds) {
    std::vector<Pair> pairs;
    for (const Bond& b : bonds.all) pairs.push_back({b.shape[0], b.joint[0], b.shape[1], b.joint[1]});
    return pairs;
}

TEST(Bonds, OfAllExamplesAreThoseOfTheDefinition) {
    size_t files = 0, bonds = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator("examples")) {
        if (entry.path().extension() != ".sgm") continue;
        SCOPED_TRACE(entry.path().string());
        syntax::Diagnostics problems;
        const auto grammar = pipeline::loadFile(entry.path(), problems);
        ASSERT_TRUE(grammar.ok());
        if (!*grammar) continue;  // a library
        for (uint32_t start = 0; start < (*grammar)->starts.size(); ++start) {
            Options options;
            options.start = start;
            const auto d = derive(*grammar, options, nullptr);
            if (!d.ok()) continue;
            const Definition defined(d->tree);
            EXPECT_EQ(pairsOf(d->tree.bonds()), defined.bonds());
            bonds += defined.bonds().size();
        }
        ++files;
    }
    EXPECT_GT(files, 40u);
    EXPECT_GT(bonds, 50'000u);
}

constexpr const char* wall =
    "grammar 2\nterminal a\nterminal b\nparam width = 6m in 2m..9m\n"
    "start Wall -> size (width, 3m, .5m) split x { { ~1m: Bay }* }\nrule Bay -> split y { 1m: a | ~1: Pane }\n";

TEST(Bonds, AreMadeWhereSomebodyAsks) {
    const auto silent = derived(std::string(wall) + "rule Pane -> b\n");
    EXPECT_EQ(silent.tree.bondsOnDemand.made(), nullptr);
    const auto asking = derived(std::string(wall) + "rule Pane beside a -> b\nrule Pane -> b\n");
    EXPECT_NE(asking.tree.bondsOnDemand.made(), nullptr);

    // Twelve panes and feet: each meets its neighbours beside it and above or below.
    EXPECT_EQ(silent.tree.bonds().all.size(), 6u * 1 + 5u * 3);
    EXPECT_EQ(pairsOf(silent.tree.bonds()), Definition(silent.tree).bonds());
    EXPECT_NE(silent.tree.bondsOnDemand.made(), nullptr);
}

/// Panes that look into many directions, each with a sill, and stones before some of them.
TEST(Bonds, OfAskedPlanesAnswerAsAllWould) {
    for (const char* turns : {"1", "3", "20"}) {
        const auto grammar =
            grammarOf("grammar 2\nterminal a\nterminal b\nparam many = " + std::string(turns) +
                      " in 1..30\n"
                      "start Town -> for k in 1..many { House turn (k * 11deg) move (20m * k, 0, 0), "
                      "a size (20m * k, 1m, 1m) move (10m * k, 0, 2.5m) }\n"
                      "rule House -> size (9m, 3m, 4m) split x { { ~1m: Bay }* }\n"
                      "rule Bay -> split y { 1m: a | ~1: Pane }\n"
                      "rule Pane -> b + a size (.5m, .1m, .1m) at +z + b size .2m at free(+x, -x, +y) + "
                      "a size .1m at -y\n");
        Options options;
        options.params = {grammar->params[0].value};
        const auto inPlanes = derive(grammar, options, nullptr);
        ASSERT_TRUE(inPlanes.ok());
        IncrementalDerivation ofAll;  // which notes whom faces meet, and so makes all bonds
        ASSERT_TRUE(ofAll.to(grammar, options, nullptr).ok());
        expectSame(ofAll.derivation(), *inPlanes);
        EXPECT_FALSE(inPlanes->closed.empty());
        EXPECT_EQ(pairsOf(inPlanes->tree.bonds()), Definition(inPlanes->tree).bonds());
    }
}

/// Boxes on a lattice, some turned, that come one after the other, and some of them by a mate.
class Boxes {
public:
    explicit Boxes(uint64_t seed) : seed_(seed) {
        tree.namedJoints.resize(2);
        tree.namedJoints[1].push_back({"tip", {0, 0, 1}, {0, 0, 1}});
        tree.namedJoints[1].push_back({"heart", {}, {}});
        Shape root;
        root.meetsNobody = true;
        tree.shapes.push_back(root);
    }
    uint32_t drawn(uint32_t of) { return static_cast<uint32_t>(pick(combine(seed_, ++draws_), of)); }
    void add() {
        const auto id = static_cast<ShapeId>(tree.shapes.size());
        Shape s;
        s.parent = id > 3 && drawn(6) == 0 ? drawn(id) : 0;
        s.scope.centre = {drawn(4) * .5, drawn(3) * .5, drawn(2) * 1.0};
        if (drawn(4) == 0) s.scope.axes = Mat3::rotation({0, 1, 0}, drawn(8) * 3.14159265358979323846 / 4);
        s.jointSet = drawn(5) == 0;
        s.meetsNobody = drawn(9) == 0;
        if (s.parent != 0) s.scope = tree.shapes.scopeOf(s.parent), s.sharesPlace = drawn(2) == 0;
        tree.shapes.push_back(s);
        if (id > 1 && drawn(3) == 0) {
            const ShapeId host = drawn(id);
            tree.mates.push_back({host, drawn(tree.jointCount(host)), id, drawn(tree.jointCount(id))});
        }
    }
    ShapeTree tree;

private:
    uint64_t seed_, draws_ = 0;
};

/// Questions while shapes come: each is answered as by the bonds of all that stand.
TEST(Bonds, InPlanesAreThoseOfAllAtAnyTime) {
    size_t asked = 0, closed = 0, bonded = 0;
    for (uint64_t seed = 1; seed <= 600; ++seed) {
        Boxes boxes(seed);
        BondsInPlanes inPlanes(boxes.tree);
        for (int i = 0; i < 60; ++i) {
            boxes.add();
            if (boxes.drawn(3) != 0) continue;
            const ShapeId id = boxes.drawn(static_cast<uint32_t>(boxes.tree.shapes.size()));
            const uint32_t joint = seed % 3 == 0 ? boxes.drawn(boxes.tree.jointCount(id)) : 4 + boxes.drawn(2);
            const auto state = inPlanes.stateOf(id, joint);
            if (!state) break;
            const Bonds all = bondsOf(boxes.tree);
            ASSERT_EQ(*state != JointState::Open, all.at(id, joint) != none) << "seed " << seed << " shape " << id;
            ASSERT_EQ(*state == JointState::Closed, all.closed(id, joint)) << "seed " << seed << " shape " << id;
            ++asked, closed += all.closed(id, joint), bonded += *state == JointState::Bonded;
        }
    }
    EXPECT_GT(asked, 3000u);
    EXPECT_GT(closed, 500u);
    EXPECT_GT(bonded, 100u);
}

TEST(Bonds, FollowAChangeThatNobodyAsked) {
    const auto grammar = grammarOf(std::string(wall) + "rule Pane -> b\n");
    IncrementalDerivation derivation;
    Options options;
    options.params = {grammar->params[0].value};
    ASSERT_TRUE(derivation.to(grammar, options, nullptr).ok());
    const auto before = derivation.derivation().tree.bonds().all;
    options.params[0].n[0] = 6.3;
    ASSERT_TRUE(derivation.to(grammar, options, nullptr).ok());
    EXPECT_FALSE(derivation.whole());
    const auto whole = derive(grammar, options, nullptr);
    expectSame(derivation.derivation(), *whole);
    EXPECT_EQ(before.size(), whole->tree.bonds().all.size());
}

TEST(Bonds, FollowASession) {
    auto session = Session::begin(grammarOf("grammar 1\nstart S -> cube + A at +x\n"
                                            "rule A -> cube\nrule A -> cube + cube at +z\n"),
                                  {}, nullptr);
    ASSERT_TRUE(session.ok());
    EXPECT_EQ(session->tree().bonds().all.size(), 1u);
    const ShapeId live = session->live().at(0);
    ASSERT_TRUE(session->apply({1, live}).ok());
    EXPECT_EQ(session->tree().bonds().all.size(), 2u);
    ASSERT_TRUE(session->undo().ok());
    EXPECT_EQ(session->tree().bonds().all.size(), 1u);
    ASSERT_TRUE(session->redo().ok());
    EXPECT_EQ(session->tree().bonds().all.size(), 2u);
}

}  // namespace
}  // namespace sgm::derive
