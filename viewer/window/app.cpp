#include "viewer/window/app.h"
#include "viewer/window/pictures.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

#include "viewer/window/bars.h"
#include "viewer/window/benchmark.h"
#include "viewer/window/panels.h"
#include "viewer/window/style.h"
#include "viewer/window/viewport.h"
#include "viewer/window/widgets.h"
#include "viewer/window/window.h"

namespace sgm::window {
namespace {

constexpr int settlingFrames = 3;     // after an event, until ImGui's hover and layout have settled
constexpr double shownEvery = 0.06;   // seconds between pictures of a view that refines itself
constexpr double refinedEvery = 0.1;  // seconds between pieces of the picture while frames are owed to the user
constexpr double listenFor = 0.5;     // seconds between looks at the file while nothing happens

/// Columns and rows of the window.
class Workspace {
public:
    explicit Workspace(Workbench& bench) : bench_(bench) {}
    /// Draws all panels; `timeline` gets a part for each.
    void show(FrameTimeline& timeline);

private:
    /// `above`: over all others.
    bool begin(const char* name, ImVec2 low, ImVec2 size, bool above = false);
    void left(ImVec2 low, ImVec2 size, FrameTimeline& timeline);
    void right(ImVec2 low, ImVec2 size, FrameTimeline& timeline);
    void view(ImVec2 low, ImVec2 size, FrameTimeline& timeline);
    void keys();  // for all of the window
    void splitter(const char* name, float x, float y, float height, float width, std::optional<float>& chosen,
                  float sign);

    Workbench& bench_;
    Bars bars_;
    ParametersPanel parameters_;
    ShapesPanel shapes_;
    RulesPanel rules_;
    TextPanel text_;
    StepPanel step_;
    ExportPanel export_;
    std::optional<float> left_, right_;  // pixels that the user has chosen; else they follow the window
};

bool Workspace::begin(const char* name, ImVec2 low, ImVec2 size, bool above) {
    ImGui::SetNextWindowPos(low);
    ImGui::SetNextWindowSize(size);
    return ImGui::Begin(name, nullptr,
                        ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                            ImGuiWindowFlags_NoCollapse |
                            (above ? ImGuiWindowFlags_NoBackground : ImGuiWindowFlags_NoBringToFrontOnFocus) |
                            ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar |
                            ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoNavFocus);
}

void Workspace::splitter(const char* name, float x, float y, float height, float width, std::optional<float>& chosen,
                         float sign) {
    constexpr float grab = 6;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));  // it would hide all of so narrow a window
    if (begin(name, {x - grab / 2, y}, {grab, height}, true)) {
        ImGui::SetCursorScreenPos({x - grab / 2, y});
        ImGui::InvisibleButton(name, {grab, height});
        bench_.report.mark(name + 2);  // without "##"
        if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
            ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
            ImGui::GetWindowDrawList()->AddLine({x, y}, {x, y + height}, tint::accent, 2);
        }
        if (ImGui::IsItemActive()) chosen = std::clamp(width + sign * ImGui::GetIO().MouseDelta.x, 200.0f, 640.0f);
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

void Workspace::left(ImVec2 low, ImVec2 size, FrameTimeline& timeline) {
    const float above = size.y * 0.5f;
    if (begin("Parameters", low, {size.x, above})) parameters_.show(bench_);
    ImGui::End();
    timeline.was("panel Parameters");
    if (begin("Shapes", {low.x, low.y + above}, {size.x, size.y - above})) shapes_.show(bench_);
    ImGui::End();
    timeline.was("panel Shapes");
    ImGui::GetForegroundDrawList()->AddLine({low.x, low.y + above}, {low.x + size.x, low.y + above},
                                            ImGui::GetColorU32(ImGuiCol_Border));
}

void Workspace::right(ImVec2 low, ImVec2 size, FrameTimeline& timeline) {
    bench_.panels.typing = false;
    const char* shown = "tabs";
    if (begin("Right", low, size) && ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_NoTooltip)) {
        const bool toText = std::exchange(bench_.panels.showText, false);
        const auto tab = [&](const char* name, const char* part, auto&& panel) {
            const bool chosen = toText && std::is_same_v<decltype(panel), TextPanel&>;
            const bool open = ImGui::BeginTabItem(name, nullptr, chosen ? ImGuiTabItemFlags_SetSelected : 0);
            bench_.report.mark(std::string("tab.") + name);
            if (!open) return false;
            panel.show(bench_);
            ImGui::EndTabItem();
            shown = part;
            return true;
        };
        tab("Rules", "panel Rules", rules_);
        if (!tab("Text", "panel Text", text_)) text_.leave();
        tab("Step", "panel Step", step_);
        tab("Export", "panel Export", export_);
        ImGui::EndTabBar();
    }
    ImGui::End();
    timeline.was(shown);
}

void Workspace::view(ImVec2 low, ImVec2 size, FrameTimeline& timeline) {
    const auto drawn = [&] {
        ElapsedTimes all = bench_.view.field.times().drawn;
        return all += bench_.view.mesh.drawn();
    };
    const ElapsedTimes before = drawn();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    if (begin("View", low, size)) viewport(bench_);
    ImGui::End();
    ImGui::PopStyleVar();
    timeline.was("panel View", drawn() - before);
}

void Workspace::keys() {
    if (!bars_.takesKeys(bench_)) return;
    bars_.keys(bench_);
    if (bench_.panels.typing || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return;
    parameters_.keys(bench_);
    viewKeys(bench_);
}

void Workspace::show(FrameTimeline& timeline) {
    bars_.leaveField(bench_);
    const ImGuiIO& io = ImGui::GetIO();
    const float leftWidth = left_.value_or(std::clamp(io.DisplaySize.x * 0.23f, 280.0f, 430.0f)),
                rightWidth = right_.value_or(std::clamp(io.DisplaySize.x * 0.31f, 340.0f, 560.0f));
    const float bar = bars_.height(), status = ImGui::GetFrameHeight() + 6, height = io.DisplaySize.y - bar - status;
    const float problems = bench_.session.problems().empty() ? 0 : std::min(ImGui::GetFrameHeight() * 4.5f, height / 3);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_MenuBarBg));
    if (begin("Bar", {0, 0}, {io.DisplaySize.x, bar})) bars_.top(bench_);
    ImGui::End();
    if (begin("Status", {0, io.DisplaySize.y - status}, {io.DisplaySize.x, status})) bars_.status(bench_);
    ImGui::End();
    ImGui::PopStyleColor();
    timeline.was("bars");
    left({0, bar}, {leftWidth, height}, timeline);
    right({io.DisplaySize.x - rightWidth, bar}, {rightWidth, height}, timeline);
    const float x = leftWidth + 1, width = io.DisplaySize.x - leftWidth - rightWidth - 2;
    view({x, bar}, {width, height - problems}, timeline);
    if (problems > 0) {
        if (begin("Problems", {x, bar + height - problems}, {width, problems})) problemsPanel(bench_);
        ImGui::End();
    }
    splitter("##left", leftWidth, bar, height, leftWidth, left_, 1);
    splitter("##right", io.DisplaySize.x - rightWidth, bar, height, rightWidth, right_, -1);
    ImGui::PopStyleVar();
    timeline.was("panel Problems");
    keys();
    timeline.was("keys");
    bars_.dialogs(bench_);
    timeline.was("dialogs");
}

/// What a test may know.
void describe(const Workbench& bench, nlohmann::json& state) {
    state["busy"] = bench.busy();
    state["drawn"] = bench.view.drawn();
    state["text"] = bench.document.text();
    state["dirty"] = bench.document.dirty();
    state["new"] = bench.panels.fileIsNew;
    state["undo"] = bench.document.history().undoLabel();
    state["redo"] = bench.document.history().redoLabel();
    state["notice"] = bench.panels.notice;
    state["problems"] = nlohmann::json::array();
    for (const document::Problem& p : bench.session.problems())
        state["problems"].push_back({{"line", p.line}, {"message", p.message}});
    state["selection"] = bench.selected() == derive::none ? "" : bench.tree()->path(bench.selected(), true);
    state["face"] = bench.view.face ? document::labelOf(*bench.view.face) : "";
    state["hover"] = bench.view.hover ? bench.view.hover->text : "";
    state["shapes"] = bench.tree() ? bench.tree()->shapes.size() : 0;
    const render::Camera camera = bench.view.orbit.camera();
    state["eye"] = {camera.eye.x, camera.eye.y, camera.eye.z};
    state["at"] = {camera.at.x, camera.at.y, camera.at.z};
    state["pane"] = static_cast<int>(bench.view.look.pane);
    state["triangles"] = bench.view.mesh.triangleCount();
    state["stepping"] = bench.steps.view() != nullptr;
    state["locked"] = bench.document.choice().locked;
    state["seed"] = bench.document.choice().seed;
    const Look& look = bench.view.look;
    state["look"] = {{"mesh", static_cast<int>(look.mesh.look)},
                     {"wire", look.mesh.wireframe},
                     {"section", look.section},
                     {"axis", look.sectionAxis},
                     {"share", look.sectionShare},
                     {"cells", look.meshResolution},
                     {"ground", look.ground},
                     {"joints", static_cast<int>(look.joints)},
                     {"navigation", static_cast<int>(look.navigation)},
                     {"motion", static_cast<int>(look.motion)},
                     {"map", bench.view.mapLayer.chosen()},
                     {"plan", look.plan}};
    state["preview"] = bench.status.previewed;
    state["lamp"] = bench.view.orbit.lamp_m;
    state["fog"] = bench.view.field.drawsFog();
    state["turning"] = bench.pictures.turntable.has_value();
    state["choice"] = {{"start", bench.document.choice().start},
                       {"style", bench.document.choice().style},
                       {"way", bench.document.choice().way}};
    state["question"] = bench.panels.question ? bench.panels.question->text : "";
}

/// Draws a little more of what is shown; true when something was drawn.
Result<bool> refine(Workbench& bench) {
    bool drew = false;
    if (bench.view.look.pane != Pane::Mesh && bench.view.field.hasField() && !bench.view.field.finished() &&
        !bench.outdated()) {
        if (const Status s = bench.view.field.step(); !s) return s.error();
        drew = true;
    }
    if (bench.view.wantsMesh() && !bench.view.mesh.finished()) {
        if (const Status s = bench.view.mesh.step(); !s) return s.error();
        drew = true;
    }
    return drew;
}

std::string titleOf(const document::Document& document) {
    const std::string name = document.path().empty() ? "untitled" : document.path().filename().string();
    return fmt::format("{}{} - sgm", document.dirty() ? "*" : "", name);
}

int fail(const Error& error) {
    fmt::print(stderr, "sgm-viewer: {}\n", error.message);
    return 1;
}

/// The loop of the window: listens, takes over what workers made, refines the picture, draws panels when something
/// changed.
class Loop {
public:
    Loop(const AppOptions& options, Window& window, Workbench& bench, Report& report)
        : options_(options), window_(window), bench_(bench), report_(report), workspace_(bench) {}

    int run() {
        for (;;)
            if (const std::optional<int> exitCode = turn()) return *exitCode;
    }

private:
    /// One round; the exit code where it was the last.
    std::optional<int> turn();
    void takeNews(FrameTimeline& timeline);
    /// Whether the picture has just become as good as it gets.
    Result<bool> refineWhenDue();
    void draw(FrameTimeline& timeline, const Stopwatch& whole);
    void writeReport();

    const AppOptions& options_;
    Window& window_;
    Workbench& bench_;
    Report& report_;
    Workspace workspace_;
    Benchmark benchmark_;
    int wanted_ = settlingFrames;
    bool refining_ = false;
    double frameSeconds_ = 0;  ///< that the last frame took
    Stopwatch sinceShown_, sinceLook_, sinceRefined_;
};

void Loop::takeNews(FrameTimeline& timeline) {
    const bool hadInput = window_.hadInput(), news = bench_.poll();
    timeline.was("taking over what workers made");
    if (hadInput || news) wanted_ = settlingFrames;
    for (const std::filesystem::path& path : window_.dropped()) bench_.drop(path);
    if (sinceLook_.seconds() > listenFor) {
        if (bench_.lookAtFiles()) wanted_ = settlingFrames;
        sinceLook_ = {};
    }
    timeline.was("files");
}

Result<bool> Loop::refineWhenDue() {
    // Input is answered first; a user who never rests still gets the picture, piece by piece.
    if (wanted_ > 0 && sinceRefined_.seconds() <= refinedEvery) return false;
    const Result<bool> drew = refine(bench_);
    if (!drew) return drew.error();
    const bool ended = refining_ && !*drew;
    refining_ = *drew;
    sinceRefined_ = {};
    return ended;
}

void Loop::writeReport() {
    if (!report_.active()) return;
    describe(bench_, report_.state());
    const Window::InputCounters& given = window_.given();
    report_.state()["still"] = wanted_ == 0 && !window_.pending();
    report_.state()["input"] = {{"x", given.x},
                                {"y", given.y},
                                {"buttons", given.buttons},
                                {"keys", given.keys},
                                {"releases", given.releases},
                                {"wheel", given.wheel}};
    report_.write();
}

void Loop::draw(FrameTimeline& timeline, const Stopwatch& whole) {
    if (wanted_ > 0) --wanted_;
    sinceShown_ = {};
    window_.setTitle(titleOf(bench_.document));
    window_.beginFrame();
    timeline.was("start of a frame");
    const bool reveals = bench_.panels.reveal.has_value();
    workspace_.show(timeline);
    if (reveals && !bench_.panels.reveal) wanted_ = settlingFrames;  // the text scrolls in the next frame
    window_.endFrame();
    timeline.drew();
    frameSeconds_ = whole.seconds();
    bench_.refresh();
    timeline.was("asking workers");
    writeReport();
    timeline.leaveOut();
}

std::optional<int> Loop::turn() {
    const bool working =
        bench_.busy() || bench_.exporting.running() || bench_.pictures.writing.valid() || options_.benchmark;
    window_.listen(wanted_ > 0 || refining_ ? 0 : working ? shownEvery : listenFor);
    const Stopwatch whole;
    FrameTimeline timeline;
    if (window_.closing()) {
        if (bench_.mayClose()) return 0;
        wanted_ = settlingFrames;  // for its question
    }
    takeNews(timeline);
    const Result<bool> ended = refineWhenDue();
    if (!ended) return fail(ended.error());
    timeline.drew();
    const Result<bool> taken = takePictures(bench_);
    if (!taken) bench_.say(taken.error().message, true);
    if (!taken || *taken) wanted_ = settlingFrames;
    timeline.was("pictures");
    // Where frames are expensive, most of the time still goes to the picture.
    if (wanted_ > 0 || *ended ||
        ((refining_ || working) && sinceShown_.seconds() >= std::max(shownEvery, 3 * frameSeconds_)))
        draw(timeline, whole);
    report_.add(timeline);
    if (bench_.panels.leaving) return 0;
    if (options_.benchmark && !benchmark_.go(bench_, timeline)) {
        benchmark_.print(bench_, window_.driver());
        return bench_.shown() ? 0 : 1;
    }
    return std::nullopt;
}

}  // namespace

int runApp(const AppOptions& options) {
    Result<std::unique_ptr<Window>> opened = Window::open("sgm", options.width, options.height);
    if (!opened) return fail(opened.error());
    Window& window = **opened;
    Report report(options.report);
    Result<std::unique_ptr<SharedContext>> shared = window.share();
    if (!shared) return fail(shared.error());
    Workbench bench(report, std::move(*shared), &Window::notify);
    if (!options.file.empty())
        if (const Status s = bench.open(options.file, !options.benchmark); !s) return fail(s.error());
    if (!options.benchmark) bench.offerAbandoned();
    return Loop(options, window, bench, report).run();
}

}  // namespace sgm::window
