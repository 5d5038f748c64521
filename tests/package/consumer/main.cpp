#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/load.h"
#include "grammar/pipeline/products.h"

int main() {
    sgm::syntax::Diagnostics problems;
    sgm::pipeline::Context context;
    const auto grammar = sgm::pipeline::load("ten.sgm", "grammar 1\nstart A -> cube + sphere at +y", problems);
    const auto model = sgm::pipeline::makeModel(grammar, *sgm::pipeline::optionsFor(*grammar, {}), context);
    const auto meshed = sgm::pipeline::makeMesh(*model, sgm::pipeline::gridOf(*model, 64), {}, context);
    return sgm::pipeline::writeMesh(*model, meshed->mesh, "ten.glb", context).ok() ? 0 : 1;
}
