// The module sgm._sgm, which the package sgm wraps.
#include "integrations/python/src/objects.h"

PYBIND11_MODULE(_sgm, module) {
    module.doc() = "The library of sgm. The package sgm is what is meant to be used.";
    module.attr("version") = SGM_VERSION;
    sgm::python::bindGrammar(module);
    sgm::python::bindMesh(module);
    sgm::python::bindScene(module);
    sgm::python::bindLevelSet(module);
    sgm::python::bindModel(module);
    sgm::python::bindLive(module);
}
