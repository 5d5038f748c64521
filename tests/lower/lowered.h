// A grammar's field, to be asked at points.
// Enters: the text of a grammar. Leaves: its derivation and field. Assumes gtest in the caller.
#pragma once

#include "grammar/lower/lower.h"
#include "modeler/eval/evaluate.h"
#include "tests/derive/grammars.h"

namespace sgm::testing_ {

struct Lowered {
    derive::Derivation derivation;
    std::unique_ptr<lower::Model> model;

    explicit Lowered(const std::string& text, derive::Options options = {}, bool joinsBoxes = false)
        : derivation(derived(text, options)) {
        auto result = lower::lower(derivation, nullptr, 1, joinsBoxes);
        if (!result.ok()) {
            ADD_FAILURE() << result.error().message;
            return;
        }
        model = std::move(*result);
        tape_ = eval::compile(model->graph, model->field, model->graph.constants());
    }
    const eval::Tape& tape() const { return tape_; }
    float value(Vec3f p) const {
        float out = 0;
        eval::evaluate(tape_, {&p.x, &p.y, &p.z, 1}, &out, workspace_);
        return out;
    }
    bool inside(Vec3f p) const { return value(p) < 0; }
    const Part& owner(Vec3f p) const {
        OriginId id = 0;
        eval::evaluateOrigin(tape_, {&p.x, &p.y, &p.z, 1}, &id, workspace_);
        return model->provenance.parts[id];
    }

private:
    eval::Tape tape_;
    mutable eval::Workspace workspace_{eval::Isa::Portable};
};

}  // namespace sgm::testing_
