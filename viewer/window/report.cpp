#include "viewer/window/report.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace sgm::window {

struct Report::Data {
    nlohmann::json widgets = nlohmann::json::object(), state = nlohmann::json::object();
    uint64_t frame = 0;
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

void Report::write() {
    if (!active()) return;
    const nlohmann::json all{{"frame", ++data_->frame}, {"widgets", data_->widgets}, {"state", data_->state}};
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
