#include "viewer/render/batched_evaluator.h"

#include <utility>

namespace sgm::render {

template <class Evaluate, class Take>
void BatchedEvaluator::byTape(const std::vector<Question>& questions, TraceCost& cost, Evaluate&& evaluate,
                              Take&& take) {
    const size_t n = questions.size();
    next_.resize(n);
    touched_.clear();
    for (auto i = static_cast<uint32_t>(n); i-- > 0;) {
        uint32_t& first = first_[questions[i].tape];
        if (first == none) touched_.push_back(questions[i].tape);
        next_[i] = std::exchange(first, i);
    }
    for (const uint32_t number : touched_) {
        x_.clear(), y_.clear(), z_.clear();
        const uint32_t first = std::exchange(first_[number], none);
        for (uint32_t i = first; i != none; i = next_[i]) {
            const Vec3f& p = questions[i].place;
            x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z);
        }
        const eval::Tape& tape = tree_->tapes[number];
        answers_.resize(x_.size());
        evaluate(tape, eval::Points{x_.data(), y_.data(), z_.data(), x_.size()});
        cost.instructions += tape.size() * x_.size();
        size_t k = 0;
        for (uint32_t i = first; i != none; i = next_[i]) take(i, k++);
    }
}

const std::vector<float>& BatchedEvaluator::of(const std::vector<Question>& questions, TraceCost& cost) {
    values_.resize(questions.size());
    byTape(
        questions, cost,
        [&](const eval::Tape& tape, eval::Points places) { eval::evaluate(tape, places, answers_.data(), workspace_); },
        [&](uint32_t i, size_t k) { values_[i] = answers_[k]; });
    return values_;
}

const std::vector<BatchedEvaluator::Slope>& BatchedEvaluator::slopesOf(const std::vector<Question>& questions,
                                                                       TraceCost& cost) {
    slopes_.resize(questions.size());
    byTape(
        questions, cost,
        [&](const eval::Tape& tape, eval::Points places) {
            for (std::vector<float>* d : {&dx_, &dy_, &dz_}) d->resize(places.n);
            eval::evaluateGradient(tape, places, answers_.data(), dx_.data(), dy_.data(), dz_.data(), workspace_);
        },
        [&](uint32_t i, size_t k) {
            slopes_[i] = {answers_[k], {dx_[k], dy_[k], dz_[k]}};
        });
    return slopes_;
}

}  // namespace sgm::render
