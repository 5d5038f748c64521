#include "modeler/volume/plugin_functions.h"

#include <tbb/parallel_for.h>

#include <chrono>
#include <thread>

namespace {

/// One short sleep a thread, so that each of them is wanted.
void startThreads(int most) {
    using namespace std::chrono_literals;
    tbb::parallel_for(
        0, 4 * most, [](int) { std::this_thread::sleep_for(200us); }, tbb::simple_partitioner());
}

}  // namespace

const sgm::volume::PluginFunctions sgm_volume_functions{
    &sgm::volume::airOf,    &sgm::volume::dense,       &sgm::volume::fillVdb, &sgm::volume::fog,
    &sgm::volume::keepOnly, &sgm::volume::renormalize, &sgm::volume::sample,  &startThreads};
