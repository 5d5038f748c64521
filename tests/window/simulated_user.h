// A simulated user at the window: a display of its own (Xvfb), the program, real clicks and keys (xdotool), and what
// the program reports of its widgets and its state. Pictures of every step are kept under build/window/.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sgm::window::test {

class SimulatedUser : public testing::Test {
protected:
    static void SetUpTestSuite();
    static void TearDownTestSuite();
    void SetUp() override;
    void TearDown() override;

    /// Starts the program with a copy of an example in this test's folder, and waits for its first picture.
    void open(const std::string& example);
    /// The same with a text of the test's own.
    void openText(const std::string& text, const std::string& name = "test.sgm");
    void start();
    void kill();

    /// What the program last reported.
    nlohmann::json report() const;
    nlohmann::json state() const { return report()["state"]; }
    std::string text() const { return state()["text"]; }
    /// Waits until the state is so; throws after 30 s, naming what it waited for.
    nlohmann::json until(const std::string& what, const std::function<bool(const nlohmann::json& state)>& holds,
                         double seconds = 30);
    /// Until every pixel is final.
    void drawn() {
        until(
            "the whole picture", [](const auto& s) { return s["drawn"] == true && !s["busy"]; }, 120);
    }
    /// Until nothing is computed any more.
    nlohmann::json settled();
    bool has(const std::string& widget) const { return report()["widgets"].contains(widget); }

    /// Rests on a place of a widget, given in shares of its width and height.
    void point(const std::string& widget, double x = 0.5, double y = 0.5);
    void click(const std::string& widget, double x = 0.5, double y = 0.5, int button = 1);
    /// A click that waits for nothing, for a program at work.
    void poke(const std::string& widget, double x = 0.5);
    /// Presses a key; waits for nothing.
    void press(const std::string& key) { tool({"key", key}); }
    /// Holds a widget, drags it to a share of its width, acts and lets go; waits for nothing, for a program at work.
    void dragAtWork(const std::string& widget, double x, const std::function<void()>& act);
    /// Presses at one place of a widget, moves to another and lets go.
    void drag(const std::string& widget, double fromX, double fromY, double toX, double toY, int button = 1);
    /// Looks at what shows while a widget is held and dragged; lets go of it where it was.
    void hold(const std::string& widget, const std::function<void()>& look);
    void dragTo(const std::string& from, int x, int y);
    void dragTo(const std::string& from, std::pair<int, int> place) { dragTo(from, place.first, place.second); }
    /// A place of a widget on the screen, in shares of its width and height.
    std::pair<int, int> placeOf(const std::string& widget, double x, double y);
    void wheel(const std::string& widget, int clicks);
    void key(const std::string& keys);
    /// Acts while a key is down.
    void holding(const std::string& key, const std::function<void()>& act);
    /// Presses keys one after the other, faster than a model is made.
    void keys(const std::vector<std::string>& keys);
    /// Drops a file on the window as a file manager does.
    void dropFile(const std::filesystem::path& file);
    /// Asks the window to close, as a window manager does; waits for nothing.
    void requestClose();
    void type(const std::string& text);
    /// A click and then commands, all sent at once.
    void burst(const std::string& widget, const std::vector<std::string>& keys);
    /// Replaces what a text field holds.
    void fill(const std::string& field, const std::string& text);
    /// Keeps a picture of the screen as build/window/TEST-NAME.png.
    void shoot(const std::string& name) const;

    std::string fileText() const;
    /// The program's resident memory in bytes.
    size_t residentBytes() const;
    std::filesystem::path folder, file;
    /// Moves the pointer to a place of the screen, outside the window too; waits for nothing.
    void pointAway(int x, int y) { tool({"mousemove", std::to_string(x), std::to_string(y)}); }
    std::string size = "1280x800";  ///< of the window, pixels; all of the screen

private:
    /// Sends input, and waits until the program has taken it and its widgets have come to rest.
    void send(const std::vector<std::string>& arguments, const std::function<bool(const nlohmann::json& input)>& taken);
    void move(int x, int y);
    void press(int button);
    void release(int button);
    void tool(const std::vector<std::string>& arguments) const;

    pid_t program_ = 0;
    static pid_t server_;
    static std::string display_;
    static std::filesystem::path screen_;
};

}  // namespace sgm::window::test
