// Tests that draw: without EGL they say so and are skipped.
#pragma once

#include <gtest/gtest.h>

#include "viewer/render/gpu.h"

namespace sgm::render::test {

class OnGpu : public testing::Test {
protected:
    void SetUp() override {
        const auto gpu = GpuContext::create();
        if (!gpu) GTEST_SKIP() << "nothing can be drawn here: " << gpu.error().message;
    }
};

}  // namespace sgm::render::test
