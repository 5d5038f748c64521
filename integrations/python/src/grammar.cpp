// Grammars from files and texts, and the models they make.
#include <pybind11/stl.h>

#include "grammar/pipeline/load.h"
#include "grammar/rules/params.h"
#include "integrations/python/src/call.h"
#include "integrations/python/src/objects.h"

namespace py = pybind11;

namespace sgm::python {
namespace {

/// The grammar with its warnings, or the exception with its errors.
Grammar checked(std::shared_ptr<const rules::Grammar> rules, const syntax::Diagnostics& diagnostics) {
    if (!rules) raise(diagnostics);
    return {std::move(rules), syntax::toJson(diagnostics)};
}

Grammar loadFile(const std::string& path) {
    syntax::Diagnostics diagnostics;
    auto loaded = [&] {
        const py::gil_scoped_release withoutLock;
        return pipeline::loadFile(path, diagnostics);
    }();
    return checked(valueOf(std::move(loaded)), diagnostics);
}

Grammar loadText(const std::string& text, const std::string& name) {
    syntax::Diagnostics diagnostics;
    auto loaded = [&] {
        const py::gil_scoped_release withoutLock;
        return pipeline::load(name, text, diagnostics);
    }();
    return checked(std::move(loaded), diagnostics);
}

Model modelOf(const Grammar& grammar, const Choice& choice, int threads, bool apart, const py::object& progress) {
    const derive::Options options = choice.optionsFor(*grammar.rules);
    Model model;
    model.threads = threads;
    model.apart = apart;
    model.made =
        std::make_shared<pipeline::Model>(staged<pipeline::Model>(progress, threads, model.stages, [&](auto& context) {
            return pipeline::makeModel(grammar.rules, options, context,
                                       apart ? pipeline::Objects::Apart : pipeline::Objects::Grafted);
        }));
    return model;
}

}  // namespace

derive::Options Choice::optionsFor(const rules::Grammar& grammar) const {
    return valueOf(pipeline::optionsFor(grammar, *this));
}

void bindGrammar(py::module_& module) {
    py::class_<Choice>(module, "Choice", "Which model of a grammar, by names.")
        .def(py::init([](const std::vector<std::string>& settings, uint64_t seed, const std::string& start,
                         const std::string& style, const std::string& derive, uint64_t shapes, double seconds) {
                 Choice choice;
                 choice.settings = settings;
                 choice.seed = seed;
                 choice.start = start;
                 choice.style = style;
                 choice.derive = derive;
                 choice.shapeBudget = shapes;
                 choice.secondsBudget = seconds;
                 return choice;
             }),
             py::arg("settings"), py::arg("seed"), py::arg("start"), py::arg("style"), py::arg("derive"),
             py::arg("max_shapes"), py::arg("max_seconds"));
    py::class_<Grammar>(module, "Grammar", "A checked grammar.")
        .def_static("load", &loadFile, py::arg("path"))
        .def_static("parse", &loadText, py::arg("text"), py::arg("name"))
        .def_property_readonly("name", [](const Grammar& g) { return g.rules->sources[0]->name(); })
        .def_property_readonly("text", [](const Grammar& g) { return std::string(g.rules->sources[0]->text()); })
        .def_property_readonly("panel", [](const Grammar& g) { return rules::panelJson(*g.rules); })
        .def_readonly("warnings", &Grammar::warnings)
        .def("model", &modelOf, py::arg("choice"), py::arg("threads"), py::arg("apart"), py::arg("progress"));
}

}  // namespace sgm::python
