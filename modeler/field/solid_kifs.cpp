#include "modeler/field/ops.h"
#include "modeler/field/solids.h"

namespace sgm::field::solids {

namespace {

/// Arguments in the row's order.
enum Parameter : size_t { Center, Scale, Fold, Turn, Passes, Terminal, Form, Bailout };

bool isIdentity(const Argument& rotation) {
    for (int i = 0; i < 9; ++i)
        if (rotation.value[i] != (i % 4 == 0 ? 1 : 0)) return false;
    return true;
}

ops::Kifs::Form formOf(std::span<const Argument> arguments) {
    ops::Kifs::Form form = kifsForm(arguments);
    form.jump = arguments[Form].value[0] > 0.5;
    form.bails = arguments[Bailout].value[0] > 0;
    return form;
}

/// The bailout is a squared radius; below 4 the terminal ball itself would be cut off.
NodeRef safeBailout(NodeRef squaredRadius) { return max(squaredRadius, 4.0f); }

}  // namespace

ops::Kifs::Form kifsForm(std::span<const Argument> arguments) {
    return {.passes = static_cast<uint32_t>(std::clamp(arguments[Passes].value[0], 1.0, 12.0)),
            .cube = arguments[Terminal].value[0] > 0.5,
            .folds = !isIdentity(arguments[Fold]),
            .turns = !isIdentity(arguments[Turn])};
}

// The fractal's cube [−max c, max c]³ (c the centre of scaling) fills the scope and is cut by it: terminal balls and
// turned branches reach over. Scaled coordinates are made good by the least scale; the maximum with the box gives
// growth 1.
Field kifs(const PrimitiveInput& in) {
    Graph& graph = in.p.x.graph();
    const auto& [cx, cy, cz] =
        Point{in.arguments[Center].node[0], in.arguments[Center].node[1], in.arguments[Center].node[2]};
    const NodeRef reach = max(max(cx, cy), cz);
    const ops::Kifs::Form form = formOf(in.arguments);

    std::vector<Operand> operands;
    operands.reserve(ops::Kifs::operandCount);
    const auto add = [&](std::initializer_list<NodeRef> list) {
        for (const NodeRef& n : list) operands.push_back({n.id(), 0});
    };
    add({in.p.x, in.p.y, in.p.z});
    add({cx, cy, cz, in.arguments[Scale].node[0]});
    for (const size_t rotation : {Fold, Turn})
        for (int i = 0; i < 9; ++i) add({in.arguments[rotation].node[i]});
    add({safeBailout(in.arguments[Bailout].node[0])});
    add({reach / in.half.x, reach / in.half.y, reach / in.half.z});

    const NodeRef value = graph.apply(codeOf<ops::Kifs>, operands, ops::Kifs::pack(form));
    const NodeRef scaled = value * (min(min(in.half.x, in.half.y), in.half.z) / reach);
    const float lipschitz = form.continuous() ? 1 : std::numeric_limits<float>::infinity();
    return {max(scaled, boxDistance(in.p, in.half)), scopeBox(in), lipschitz, growth(1)};
}

}  // namespace sgm::field::solids
