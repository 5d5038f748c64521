// A tape that follows its numbers is the one that `compile` gives, and where no changed part comes near, whatever is
// made of it stays.
#include "modeler/eval/incremental_compiler.h"

#include <gtest/gtest.h>

#include "modeler/core/random.h"
#include "modeler/eval/changed_parts.h"
#include "modeler/eval/evaluate.h"
#include "modeler/eval/fingerprint.h"
#include "modeler/field/combine.h"

namespace sgm::eval {
namespace {

using field::Field;
using field::Graph;
using field::NodeRef;

NodeRef numberOf(Graph& g, uint64_t path, uint64_t attribute, float value) { return g.slot({path, attribute}, value); }

/// Balls, every third with a smaller one cut out; four numbers each.
Field balls(Graph& g, const std::vector<Vec3f>& centres, float radius) {
    std::vector<field::Owned> parts;
    for (size_t i = 0; i < centres.size(); ++i) {
        const Vec3f c = centres[i];
        const auto n = [&](uint64_t attribute, float value) { return numberOf(g, i + 1, attribute, value); };
        const field::Point p = g.position() - field::Point{n(0, c.x), n(1, c.y), n(2, c.z)};
        const NodeRef away = field::length(p);
        NodeRef f = away - n(3, radius);
        if (i % 3 == 0) f = field::max(f, n(4, radius / 2) - away);
        parts.push_back({{f, {c - Vec3f{radius, radius, radius}, c + Vec3f{radius, radius, radius}}, 1, 1},
                         static_cast<OriginId>(i + 1)});
    }
    return field::sum(g, parts);
}

std::vector<Vec3f> scattered(size_t count) {
    std::vector<Vec3f> centres;
    for (size_t i = 0; i < count; ++i)
        centres.push_back({static_cast<float>(uniform(3 * i, -8, 8)), static_cast<float>(uniform(3 * i + 1, -8, 8)),
                           static_cast<float>(uniform(3 * i + 2, -8, 8))});
    return centres;
}

Fingerprint compiled(const Graph& g, const Field& f) { return fingerprint(compile(g, f, g.constants())); }

TEST(IncrementalCompiler, GivesWhatCompileGives) {
    Graph g;
    auto centres = scattered(40);
    IncrementalCompiler recompiler;
    const Field field = balls(g, centres, 1);
    recompiler.startOver(g, field);
    EXPECT_EQ(fingerprint(recompiler.tape()), compiled(g, field));
    for (size_t i = 0; i < 20; ++i) {
        centres[7 * i % 40].y += 0.5f;
        const auto before = recompiler.tape().sharedConstants();
        const Field moved = balls(g, centres, 1);
        ASSERT_EQ(moved.value.id(), field.value.id());
        recompiler.follow(g, moved);
        EXPECT_FALSE(recompiler.whole());
        EXPECT_EQ(recompiler.changed().before, before);
        EXPECT_EQ(recompiler.changed().places.size(), 1u);
        ASSERT_EQ(fingerprint(recompiler.tape()), compiled(g, moved));
    }
}

TEST(IncrementalCompiler, NumbersMadeOfNumbersChangeToo) {
    Graph g;
    const auto made = [&](float a, float b) {
        const NodeRef n = (numberOf(g, 1, 0, a) + numberOf(g, 1, 1, b)) * 2.0f;
        return Field{min(g.x() * n, g.y() - n), {{-1, -1, -1}, {1, 1, 1}}, 1, 1};
    };
    IncrementalCompiler recompiler;
    recompiler.startOver(g, made(1, 2));
    for (const auto& [a, b] : {std::pair{1.f, 3.f}, {2.f, 2.f}, {5.f, 2.f}}) {
        recompiler.follow(g, made(a, b));
        EXPECT_FALSE(recompiler.whole());
        EXPECT_EQ(recompiler.changed().places.size(), a == 2 ? 0u : 1u) << "a sum that stays changes nothing";
        EXPECT_EQ(fingerprint(recompiler.tape()), compiled(g, made(a, b)));
    }
}

TEST(IncrementalCompiler, StartsOverWhereANumberComesToChangeNothing) {
    Graph g;
    const auto made = [&](float a) {
        return Field{g.x() * numberOf(g, 1, 0, a) - numberOf(g, 1, 1, 3), {{-1, -1, -1}, {1, 1, 1}}, 1, 1};
    };
    IncrementalCompiler recompiler;
    recompiler.startOver(g, made(3));
    for (const auto& [a, whole] : {std::pair{2.f, false}, {1.f, true}, {1.f, false}, {5.f, true}, {4.f, false}}) {
        recompiler.follow(g, made(a));
        EXPECT_EQ(recompiler.whole(), whole) << a;
        EXPECT_EQ(fingerprint(recompiler.tape()), compiled(g, made(a)));
    }
}

TEST(ChangedParts, WhereNoneComesNearTheShortenedTapeStays) {
    Graph g;
    auto centres = scattered(60);
    IncrementalCompiler recompiler;
    recompiler.startOver(g, balls(g, centres, 1));
    Workspace before, now, asked;
    ChangedParts parts;
    const RelevantRange care{-0.2f, 0.2f};
    size_t far = 0, near = 0, alike = 0;
    for (uint64_t round = 0; round < 24; ++round) {
        const Tape then = recompiler.tape();
        for (uint64_t k = 0; k < 3; ++k)
            centres[pick(round * 3 + k, 60)].x += static_cast<float>(uniform(round, -1, 1));
        recompiler.follow(g, balls(g, centres, 1));
        ASSERT_FALSE(recompiler.whole());
        ASSERT_TRUE(parts.find(recompiler.tape(), recompiler.changed()));
        std::vector<Box3f> boxes;
        for (int i = 0; i < 64; ++i) {
            const Vec3i place{i % 4, i / 4 % 4, i / 16};
            const Vec3f lo = place.as<float>() * 5 - Vec3f{10, 10, 10};
            boxes.push_back({lo, lo + Vec3f{5, 5, 5}});
        }
        const uint64_t unreached = parts.reach(boxes, care, asked).unreached;
        std::array<FloatInterval, 64> ranges;
        const RangeTrace traceThen = evaluateRanges(then, {boxes.data(), 64}, ranges.data(), before);
        const RangeTrace traceNow = evaluateRanges(recompiler.tape(), {boxes.data(), 64}, ranges.data(), now);
        for (size_t i = 0; i < 64; ++i) {
            if (ranges[i].lo >= 0) continue;  // the descent doesn't go there
            const bool same = fingerprint(shorten(then, traceThen, i, before, care)) ==
                              fingerprint(shorten(recompiler.tape(), traceNow, i, now, care));
            const bool away = (unreached >> i & 1) != 0;
            EXPECT_TRUE(same || !away) << "round " << round << ", box " << i;
            ++(away ? far : near);
            alike += same;
        }
    }
    EXPECT_GT(far, 500u);
    EXPECT_GT(near, 50u);
    EXPECT_LT(alike, far + near) << "something must change";
}

TEST(ChangedParts, AroundABoxTheTapeHoldsWhateverNumbersCome) {
    Graph g;
    auto centres = scattered(60);
    const Vec3f start = centres[7];
    const RelevantRange care{-0.2f, 0.2f};
    IncrementalCompiler recompiler;
    recompiler.startOver(g, balls(g, centres, 1));
    Workspace asked, whole, part;
    ChangedParts parts;
    Tape around;
    const Box3f box{start - Vec3f{4, 4, 4}, start + Vec3f{4, 4, 4}};
    size_t surface = 0;
    for (uint64_t round = 0; round < 24; ++round) {
        centres[7].x = start.x + static_cast<float>(uniform(round, -9, 9));  // out of the box, and back
        recompiler.follow(g, balls(g, centres, 1));
        ASSERT_FALSE(recompiler.whole());
        const Tape& tape = recompiler.tape();
        if (round == 0) {
            ASSERT_TRUE(parts.find(tape, recompiler.changed()));
            around = parts.around(tape, box, care, asked);
            EXPECT_LT(4 * around.size(), tape.size());
        }
        TapeBuilder::rebind(around, tape.sharedConstants(), TapeBuilder::scaleOf(tape));
        std::vector<Box3f> boxes;
        for (int i = 0; i < 64; ++i) {
            const Vec3f lo = box.lo + Vec3i{i % 4, i / 4 % 4, i / 16}.as<float>() * 2.0f;
            boxes.push_back({lo, lo + Vec3f{2, 2, 2}});
        }
        std::array<FloatInterval, 64> ranges, inPart;
        const RangeTrace ofWhole = evaluateRanges(tape, {boxes.data(), 64}, ranges.data(), whole);
        const RangeTrace ofPart = evaluateRanges(around, {boxes.data(), 64}, inPart.data(), part);
        for (size_t i = 0; i < 64; ++i) {
            const bool may = ranges[i].lo < 0 && ranges[i].hi >= 0;
            ASSERT_EQ(may, inPart[i].lo < 0 && inPart[i].hi >= 0);
            if (!may) continue;
            ++surface;
            EXPECT_EQ(fingerprint(shorten(tape, ofWhole, i, whole, care)),
                      fingerprint(shorten(around, ofPart, i, part, care)))
                << "round " << round << ", box " << i;
        }
    }
    EXPECT_GT(surface, 200u);
}

TEST(ChangedParts, TooManyAreRefused) {
    Graph g;
    auto centres = scattered(20);
    IncrementalCompiler recompiler;
    recompiler.startOver(g, balls(g, centres, 1));
    recompiler.follow(g, balls(g, centres, 1.5f));
    ASSERT_FALSE(recompiler.whole());
    ChangedParts parts;
    EXPECT_FALSE(parts.find(recompiler.tape(), recompiler.changed()));
}

}  // namespace
}  // namespace sgm::eval
