#include "tests/window/simulated_user.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "viewer/render/camera.h"
#include "viewer/render/picture.h"

namespace sgm::window::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

bool isInstalled(const std::string& program) {
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

/// Starts a program; `prepare` runs in the child before it.
pid_t spawn(const std::vector<std::string>& words, const std::function<void()>& prepare) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    prepare();
    execvp(arguments[0], arguments.data());
    _exit(127);
}

void silence() {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, 1);
    dup2(nowhere, 2);
}

std::string contentOf(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// The program's bit of one of X's buttons: left, middle, right there; left, right, middle here.
unsigned bitOf(int button) { return button == 2 ? 4 : button == 3 ? 2 : 1; }

/// Keys in a chord such as "ctrl+z".
uint64_t keysIn(const std::string& chord) {
    return static_cast<uint64_t>(std::count(chord.begin(), chord.end(), '+') + 1);
}

/// The screen that Xvfb keeps in a file of X's own dump format (XWD): a header of big-endian words, colours, rows of
/// BGRX.
render::Image screenOf(const fs::path& dump) {
    const std::string bytes = contentOf(dump);
    const auto word = [&](size_t i) {
        uint32_t value = 0;
        for (size_t b = 0; b < 4; ++b) value = value << 8 | static_cast<uint8_t>(bytes[i * 4 + b]);
        return size_t(value);
    };
    if (bytes.size() < 100) return {};
    const size_t width = word(4), height = word(5), row = word(12), begin = word(0) + word(19) * 12;
    render::Image image{static_cast<int>(width), static_cast<int>(height), {}};
    for (size_t y = 0; y < height; ++y)
        for (size_t x = 0; x < width; ++x)
            for (const size_t c : {2u, 1u, 0u})
                image.rgb.push_back(static_cast<uint8_t>(bytes.at(begin + y * row + x * 4 + c)));
    return image;
}

}  // namespace

pid_t SimulatedUser::server_ = 0;
std::string SimulatedUser::display_;
fs::path SimulatedUser::screen_;

void SimulatedUser::SetUpTestSuite() {
    if (!isInstalled("Xvfb") || !isInstalled("xdotool")) return;
    screen_ = fs::temp_directory_path() / ("sgm_screen_" + std::to_string(getpid()));
    fs::create_directories(screen_);
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    server_ = spawn({"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0", "1280x800x24", "-nolisten", "tcp",
                     "-fbdir", screen_.string()},
                    silence);
    close(ends[1]);
    // The number of the display comes once the server is ready.
    std::string number;
    for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    close(ends[0]);
    if (!number.empty()) display_ = ":" + number;
}

void SimulatedUser::TearDownTestSuite() {
    if (server_ <= 0) return;
    ::kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
    fs::remove_all(screen_);
}

void SimulatedUser::SetUp() {
    if (display_.empty()) GTEST_SKIP() << "no window can be driven here: Xvfb or xdotool isn't installed";
    folder = fs::temp_directory_path() / ("sgm_window_" + std::to_string(getpid()));
    fs::create_directories(folder);
}

void SimulatedUser::TearDown() {
    if (display_.empty()) return;
    if (HasFailure()) shoot("failed");
    kill();
    fs::remove_all(folder);
}

void SimulatedUser::open(const std::string& example) {
    file = folder / fs::path(example).filename();
    fs::copy_file(example, file, fs::copy_options::overwrite_existing);
    start();
}

void SimulatedUser::openText(const std::string& text, const std::string& name) {
    file = folder / name;
    std::ofstream(file) << text;
    start();
}

void SimulatedUser::start() {
    fs::remove(folder / "report.json");
    program_ = spawn({SGM_VIEWER, file.string(), "--size", size, "--report", (folder / "report.json").string()}, [&] {
        setenv("DISPLAY", display_.c_str(), 1);
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        setenv("XDG_STATE_HOME", (folder / "state").c_str(), 1);
        const int log = ::open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
        dup2(log, 1);
        dup2(log, 2);
    });
    until("a window", [](const auto&) { return true; });
    // Without a window manager nobody else gives it the keys.
    tool({"search", "--sync", "--onlyvisible", "--name", "- sgm$", "windowfocus", "sleep", "0.1"});
    until("a model", [](const auto& s) { return s["shapes"] > 0 && !s["busy"]; });
}

void SimulatedUser::kill() {
    if (program_ <= 0) return;
    ::kill(program_, SIGKILL);
    waitpid(program_, nullptr, 0);
    program_ = 0;
}

nlohmann::json SimulatedUser::report() const {
    const auto parsed = nlohmann::json::parse(contentOf(folder / "report.json"), nullptr, false);
    return parsed.is_object() ? parsed
                              : nlohmann::json{{"frame", 0},
                                               {"widgets", nlohmann::json::object()},
                                               {"state", {{"shapes", 0}, {"busy", true}, {"still", false}}}};
}

nlohmann::json SimulatedUser::until(const std::string& what, const std::function<bool(const nlohmann::json&)>& holds,
                                    double seconds) {
    for (double waited = 0; waited < seconds; waited += 0.01) {
        const nlohmann::json now = state();
        if (now.contains("text") && holds(now)) return now;
        if (program_ > 0 && waitpid(program_, nullptr, WNOHANG) == program_) {
            program_ = 0;
            throw std::runtime_error("the program ended:\n" + contentOf(folder / "log"));
        }
        std::this_thread::sleep_for(10ms);
    }
    throw std::runtime_error("waited in vain for " + what + "\n" + report().dump(1));
}

nlohmann::json SimulatedUser::settled() {
    return until("an idle program", [](const auto& s) { return !s["busy"] && s["still"]; });
}

void SimulatedUser::send(const std::vector<std::string>& arguments,
                         const std::function<bool(const nlohmann::json&)>& taken) {
    tool(arguments);
    until("what xdotool sends to be taken", [&](const auto& s) { return taken(s["input"]) && s["still"]; });
}

void SimulatedUser::move(int x, int y) {
    send({"mousemove", std::to_string(x), std::to_string(y)},
         [&](const auto& input) { return input["x"] == x && input["y"] == y; });
}

void SimulatedUser::press(int button) {
    send({"mousedown", std::to_string(button)},
         [&](const auto& input) { return (input["buttons"].template get<unsigned>() & bitOf(button)) != 0; });
}

void SimulatedUser::release(int button) {
    send({"mouseup", std::to_string(button)},
         [&](const auto& input) { return (input["buttons"].template get<unsigned>() & bitOf(button)) == 0; });
    settled();
}

void SimulatedUser::tool(const std::vector<std::string>& arguments) const {
    std::vector<std::string> words{"xdotool"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const pid_t child = spawn(words, [&] {
        setenv("DISPLAY", display_.c_str(), 1);
        silence();
    });
    waitpid(child, nullptr, 0);
}

std::pair<int, int> SimulatedUser::placeOf(const std::string& widget, double x, double y) {
    nlohmann::json box;
    until("the widget " + widget,
          [&](const auto&) { return !(box = report()["widgets"].value(widget, nlohmann::json())).is_null(); });
    return {static_cast<int>(box[0].get<double>() + x * box[2].get<double>()),
            static_cast<int>(box[1].get<double>() + y * box[3].get<double>())};
}

void SimulatedUser::point(const std::string& widget, double x, double y) {
    const auto [px, py] = placeOf(widget, x, y);
    move(px, py);
}

void SimulatedUser::click(const std::string& widget, double x, double y, int button) {
    point(widget, x, y);
    press(button);
    release(button);
}

void SimulatedUser::poke(const std::string& widget, double x) {
    const auto [px, py] = placeOf(widget, x, 0.5);
    tool({"mousemove", std::to_string(px), std::to_string(py), "mousedown", "1", "mouseup", "1"});
}

void SimulatedUser::dragAtWork(const std::string& widget, double x, const std::function<void()>& act) {
    const auto [fx, fy] = placeOf(widget, 0.1, 0.5);
    const auto [tx, ty] = placeOf(widget, x, 0.5);
    move(fx, fy);
    press(1);
    tool({"mousemove", std::to_string(tx), std::to_string(ty)});
    act();
    tool({"mouseup", "1"});
}

void SimulatedUser::drag(const std::string& widget, double fromX, double fromY, double toX, double toY, int button) {
    const auto [fx, fy] = placeOf(widget, fromX, fromY);
    const auto [x, y] = placeOf(widget, toX, toY);
    move(fx, fy);
    press(button);
    move((x + fx) / 2, (y + fy) / 2);
    move(x, y);
    release(button);
}

void SimulatedUser::hold(const std::string& widget, const std::function<void()>& look) {
    const auto [x, y] = placeOf(widget, 0.5, 0.5);
    move(x, y);
    press(1);
    move(x + 12, y + 6);
    look();
    move(x, y);
    release(1);
}

void SimulatedUser::dragTo(const std::string& from, int x, int y) {
    const auto [fx, fy] = placeOf(from, 0.5, 0.5);
    move(fx, fy);
    press(1);
    move(fx + 12, fy + 6);
    move(x - 4, y);
    move(x, y);
    release(1);
}

void SimulatedUser::wheel(const std::string& widget, int clicks) {
    point(widget);
    const double wanted = state()["input"]["wheel"].get<double>() + clicks;
    send({"click", "--repeat", std::to_string(std::abs(clicks)), "--delay", "10", clicks > 0 ? "4" : "5"},
         [&](const auto& input) { return input["wheel"] == wanted; });
    settled();
}

void SimulatedUser::burst(const std::string& widget, const std::vector<std::string>& keys) {
    const auto [x, y] = placeOf(widget, 0.5, 0.5);
    std::vector<std::string> words{
        "mousemove", std::to_string(x), std::to_string(y), "mousedown", "1", "mouseup", "1", "key", "--delay",
        "4"};  // GLFW takes one press of a key a millisecond
    words.insert(words.end(), keys.begin(), keys.end());
    uint64_t wanted = state()["input"]["releases"];
    for (const std::string& k : keys) wanted += keysIn(k);
    send(words,
         [&](const auto& input) { return input["releases"] >= wanted && input["keys"] == 0 && input["buttons"] == 0; });
    settled();
}

void SimulatedUser::key(const std::string& keys) {
    const uint64_t wanted = state()["input"]["releases"].get<uint64_t>() + keysIn(keys);
    send({"key", keys}, [&](const auto& input) { return input["releases"] >= wanted && input["keys"] == 0; });
    settled();
}

void SimulatedUser::holding(const std::string& key, const std::function<void()>& act) {
    send({"keydown", key}, [](const auto& input) { return input["keys"] == 1; });
    act();
    send({"keyup", key}, [](const auto& input) { return input["keys"] == 0; });
}

void SimulatedUser::keys(const std::vector<std::string>& keys) {
    std::vector<std::string> words{"key", "--delay", "4"};
    words.insert(words.end(), keys.begin(), keys.end());
    const uint64_t wanted = state()["input"]["releases"].get<uint64_t>() + keys.size();
    send(words, [&](const auto& input) { return input["releases"] >= wanted && input["keys"] == 0; });
    settled();
}

void SimulatedUser::type(const std::string& text) {
    const uint64_t wanted = state()["input"]["releases"].get<uint64_t>() + text.size();
    send({"type", "--delay", "5", text},
         [&](const auto& input) { return input["releases"] >= wanted && input["keys"] == 0; });
    settled();
}

void SimulatedUser::fill(const std::string& field, const std::string& text) {
    click(field, 0.3);
    key("ctrl+a");
    type(text);
    key("Return");
}

void SimulatedUser::shoot(const std::string& name) const {
    const fs::path pictures = "build/window";
    fs::create_directories(pictures);
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    const Status written = writePng(screenOf(screen_ / "Xvfb_screen0"), pictures / (test + "-" + name + ".png"));
    EXPECT_TRUE(written.ok());
}

std::string SimulatedUser::fileText() const { return contentOf(file); }

size_t SimulatedUser::residentBytes() const {
    std::istringstream pages(contentOf("/proc/" + std::to_string(program_) + "/statm"));
    size_t all = 0, resident = 0;
    pages >> all >> resident;
    return resident * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace sgm::window::test
