#include "viewer/window/report.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

namespace sgm::window {
namespace {

constexpr double longGap = 0.05;  // seconds

}  // namespace

struct Report::Data {
    /// How long the window looked away from the user's input by one clock, over all turns.
    struct Gaps {
        double ElapsedTimes::*clock;
        uint64_t over = 0;                         ///< gaps over 50 ms
        std::map<std::string, uint64_t> most{};    ///< these, by the part that took most of them
        double longest = 0;                        ///< seconds
        uint64_t frame = 0;                        ///< before the longest
        std::vector<FrameTimeline::Part> parts{};  ///< of the longest

        void add(const std::vector<FrameTimeline::Part>& turn, uint64_t frameBefore) {
            double gap = 0;
            for (const FrameTimeline::Part& part : turn) gap += part.spent.*clock;
            if (gap > longGap) {
                ++over;
                ++most[std::max_element(turn.begin(), turn.end(), [&](const auto& a, const auto& b) {
                           return a.spent.*clock < b.spent.*clock;
                       })->name];
            }
            if (gap <= longest) return;
            longest = gap;
            frame = frameBefore;
            parts = turn;
        }
        nlohmann::json told() const {
            nlohmann::json all{{"over", over},
                               {"most", most},
                               {"longest", longest},
                               {"frame", frame},
                               {"parts", nlohmann::json::object()}};
            for (const auto& [name, spent] : parts) all["parts"][name] = spent.*clock;
            return all;
        }
    };
    struct Clocks {
        Gaps wall{&ElapsedTimes::wall}, processor{&ElapsedTimes::processor};
        void add(const std::vector<FrameTimeline::Part>& turn, uint64_t frameBefore) {
            wall.add(turn, frameBefore);
            processor.add(turn, frameBefore);
        }
        nlohmann::json told() const { return {{"wall", wall.told()}, {"processor", processor.told()}}; }
    };

    nlohmann::json widgets = nlohmann::json::object(), state = nlohmann::json::object();
    uint64_t frame = 0, turns = 0;
    Clocks undrawn, whole;
};

Report::Report(std::filesystem::path file) : file_(std::move(file)), data_(std::make_unique<Data>()) {}
Report::~Report() = default;

void Report::mark(const std::string& name) {
    if (active() && ImGui::IsItemVisible()) mark(name, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
}

void Report::mark(const std::string& name, ImVec2 low, ImVec2 high) {
    if (active()) data_->widgets[name] = {low.x, low.y, high.x - low.x, high.y - low.y};
}

nlohmann::json& Report::state() { return data_->state; }

void Report::add(const FrameTimeline& turn) {
    if (!active()) return;
    ++data_->turns;
    std::vector<FrameTimeline::Part> parts = turn.parts();
    data_->undrawn.add(parts, data_->frame);
    parts.push_back({"drawing", turn.drawn()});
    data_->whole.add(parts, data_->frame);
}

void Report::write() {
    if (!active()) return;
    const nlohmann::json all{{"frame", ++data_->frame},
                             {"widgets", data_->widgets},
                             {"state", data_->state},
                             {"gaps",
                              {{"turns", data_->turns},
                               {"drawing excluded", data_->undrawn.told()},
                               {"drawing included", data_->whole.told()}}}};
    data_->widgets = nlohmann::json::object();
    data_->state = nlohmann::json::object();
    // Not `replaceFile`: this needn't outlive a power cut, and comes with every frame.
    std::filesystem::path temporary = file_;
    temporary += ".new";
    std::ofstream(temporary) << all.dump(1) << "\n";
    std::error_code failed;
    std::filesystem::rename(temporary, file_, failed);
    if (failed) file_.clear();  // nowhere to report to
}

}  // namespace sgm::window
