// The field at many places of many cells: those of one tape are evaluated together.
// Enters: questions of rays. Leaves: values, in the questions' order. Assumes one object a thread.
#pragma once

#include <span>
#include <vector>

#include "modeler/eval/evaluate.h"
#include "viewer/render/sphere_tracer.h"
#include "viewer/render/tracer.h"

namespace sgm::render {

class BatchedEvaluator {
public:
    explicit BatchedEvaluator(const CellTree& tree) : tree_(&tree), first_(tree.tapes.size(), none) {}

    /// values[i] is the field at questions[i]; valid until the next call. Adds the instructions to `cost`.
    const std::vector<float>& of(const std::vector<Question>& questions, TraceCost& cost);
    /// The same with derivatives: one evaluation each, of a few times the instructions' time.
    struct Slope {
        float value;
        Vec3f gradient;
    };
    const std::vector<Slope>& slopesOf(const std::vector<Question>& questions, TraceCost& cost);

    /// Takes every walk to its end; gives the number of evaluations.
    template <class Walk>
    uint64_t follow(const CellSpace& space, std::span<Walk> walks, TraceCost& cost) {
        std::vector<uint32_t> live(walks.size());
        for (size_t i = 0; i < live.size(); ++i) live[i] = static_cast<uint32_t>(i);
        std::vector<Question> questions;
        uint64_t evaluations = 0;
        while (!live.empty()) {
            questions.clear();
            size_t kept = 0;
            for (const uint32_t i : live) {
                Question question;
                if (!walks[i].ask(space, question)) continue;
                questions.push_back(question);
                live[kept++] = i;
            }
            live.resize(kept);
            const std::vector<float>& values = of(questions, cost);
            for (size_t k = 0; k < kept; ++k) walks[live[k]].answer(space, space.side * values[k]);
            evaluations += kept;
        }
        return evaluations;
    }

private:
    static constexpr uint32_t none = 0xffffffffu;
    /// For every tape that is asked: evaluate(tape, places), then take(question, number among the places).
    template <class Evaluate, class Take>
    void byTape(const std::vector<Question>& questions, TraceCost& cost, Evaluate&& evaluate, Take&& take);

    const CellTree* tree_;
    eval::Workspace workspace_;
    std::vector<uint32_t> first_, next_, touched_;  // lists of the questions of a tape
    std::vector<float> x_, y_, z_, answers_, dx_, dy_, dz_, values_;
    std::vector<Slope> slopes_;
};

}  // namespace sgm::render
