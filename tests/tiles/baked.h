// A grammar's model, baked into folders of tests.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "grammar/pipeline/bake.h"
#include "grammar/pipeline/load.h"

namespace sgm::pipeline {

class Baked {
public:
    /// `name` is the grammar's file, beside which its pictures lie.
    explicit Baked(const std::string& text, const std::string& name = "town.sgm") {
        syntax::Diagnostics problems;
        const auto grammar = load(name, text, problems);
        EXPECT_TRUE(grammar) << (problems.all().empty() ? "" : problems.all()[0].message);
        model_ = std::make_unique<Model>(*makeModel(grammar, *optionsFor(*grammar, {}), context_, Objects::Apart));
    }
    /// Bakes a task into a folder.
    void run(const std::filesystem::path& folder, tiles::Share share, int threads = 1) {
        Context context{nullptr, threads};
        const BakeRequest request = requestFor(folder);
        auto bake = Bake::begin(*model_, request, context);
        ASSERT_TRUE(bake.ok()) << bake.error().message;
        plan = bake->plan();
        const Status done = bake->run(share, context);
        ASSERT_TRUE(done.ok()) << done.error().message;
        missing = bake->missing(7);
    }
    /// Bakes the cells that `wanted` tells.
    template <class Wanted>
    void runCells(const std::filesystem::path& folder, Wanted wanted) {
        Context context{nullptr, 2};
        const BakeRequest request = requestFor(folder);
        auto bake = Bake::begin(*model_, request, context);
        ASSERT_TRUE(bake.ok()) << bake.error().message;
        plan = bake->plan();
        std::vector<size_t> cells;
        for (size_t i = 0; i < plan.cells.size(); ++i)
            if (wanted(plan.cells[i])) cells.push_back(i);
        const Status done = bake->runCells(cells, context);
        ASSERT_TRUE(done.ok()) << done.error().message;
    }
    void merge(const std::filesystem::path& folder) {
        const Status merged = tiles::merge(folder, tiles::EarthPlace{52.5, 13.4}, true);
        ASSERT_TRUE(merged.ok()) << merged.error().message;
    }

    double side_m = 64;
    tiles::BakePlan plan;
    std::vector<int> missing;

private:
    BakeRequest requestFor(const std::filesystem::path& folder) const {
        return {.folder = folder, .side_m = side_m, .cell_m = 1, .objectCell_m = .5, .levels = 3, .budget = {}};
    }

    Context context_{nullptr, 2};
    std::unique_ptr<Model> model_;
};

}  // namespace sgm::pipeline
