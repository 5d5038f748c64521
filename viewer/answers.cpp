#include "viewer/answers.h"

#include <utility>

namespace sgm::viewer {

const std::vector<float>& Answers::of(const std::vector<Question>& questions, TraceCost& cost) {
    const size_t n = questions.size();
    next_.resize(n);
    touched_.clear();
    for (auto i = static_cast<uint32_t>(n); i-- > 0;) {
        uint32_t& first = first_[questions[i].tape];
        if (first == none) touched_.push_back(questions[i].tape);
        next_[i] = std::exchange(first, i);
    }
    values_.resize(n);
    for (const uint32_t tape : touched_) {
        x_.clear(), y_.clear(), z_.clear();
        const uint32_t first = std::exchange(first_[tape], none);
        for (uint32_t i = first; i != none; i = next_[i]) {
            const Vec3f& p = questions[i].place;
            x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z);
        }
        answers_.resize(x_.size());
        eval::evaluate(tree_->tapes[tape], {x_.data(), y_.data(), z_.data(), x_.size()}, answers_.data(), workspace_);
        cost.instructions += tree_->tapes[tape].size() * x_.size();
        const float* answer = answers_.data();
        for (uint32_t i = first; i != none; i = next_[i]) values_[i] = *answer++;
    }
    return values_;
}

}  // namespace sgm::viewer
