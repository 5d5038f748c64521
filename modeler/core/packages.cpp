#include "modeler/core/packages.h"

namespace sgm {
namespace {

struct Row {
    Package package;
    bool isThere;
    const char* name;
    const char* option;
};

constexpr Row rows[] = {
    {Package::OpenVdb, SGM_HAS_OPENVDB, "OpenVDB", "SGM_OPENVDB"},
    {Package::Cgal, SGM_HAS_CGAL, "CGAL", "SGM_CGAL"},
    {Package::Window, SGM_HAS_WINDOW, "the window", "SGM_WINDOW"},
};

const Row& rowOf(Package package) {
    const Row* row = rows;
    while (row->package != package) ++row;
    return *row;
}

}  // namespace

bool isBuiltWith(Package package) { return rowOf(package).isThere; }

Error missingPackage(Package package, const std::string& subject) {
    const Row& row = rowOf(package);
    return {Error::Kind::Input,
            subject + " needs " + row.name + ": this sgm was built without it (" + row.option + "=OFF)"};
}

}  // namespace sgm
