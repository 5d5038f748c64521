// The system's window with an OpenGL context and Dear ImGui in it.
// Enters: a title and a size. Leaves: events and frames. Assumes the main thread and one window.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "modeler/core/result.h"

struct GLFWwindow;

namespace sgm::window {

/// A context of OpenGL for another thread, whose buffers, textures and programs are the window's too.
class SharedContext {
public:
    explicit SharedContext(GLFWwindow* hidden) : hidden_(hidden) {}
    ~SharedContext();
    SharedContext(const SharedContext&) = delete;
    SharedContext& operator=(const SharedContext&) = delete;
    /// Takes it on this thread, and gives it back before the thread ends.
    void take() const;
    void giveBack() const;

private:
    GLFWwindow* hidden_;
};

class Window {
public:
    /// Error::Internal where there is no display or no OpenGL 4.5.
    static Result<std::unique_ptr<Window>> open(const std::string& title, int width, int height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Handles what has happened, and waits for it at most `seconds` (0: not at all).
    void listen(double seconds);
    /// Something was pressed, moved, resized or uncovered since the last call.
    bool hadInput();
    /// Files dropped on the window since the last call.
    std::vector<std::filesystem::path> dropped();
    /// The user asked to close it, since the last call.
    bool closing();
    /// Input waits for the next frame.
    bool pending() const { return !input_.empty(); }
    /// What frames have been given so far.
    struct InputCounters {
        double x = 0, y = 0;    ///< the pointer, pixels of the window
        unsigned buttons = 0;   ///< that are down, a bit each
        unsigned keys = 0;      ///< that are down
        uint64_t releases = 0;  ///< of keys
        double wheel = 0;       ///< clicks, up is positive
    };
    const InputCounters& given() const { return given_; }
    /// Ends a `listen` from any thread.
    static void notify();

    /// Dies before the window. Error::Internal where the driver refuses a second context.
    Result<std::unique_ptr<SharedContext>> share() const;

    void setTitle(const std::string& title);
    /// Between these two ImGui may be used; `endFrame` shows what it made.
    void beginFrame();
    void endFrame();
    /// Renderer and version, as the driver calls itself.
    std::string driver() const;

private:
    Window() = default;
    struct Event {
        enum class Kind { Key, Letter, Move, Button, Wheel } kind;
        int code = 0;  ///< GLFW's of a key or a button
        bool down = false;
        unsigned letter = 0;  ///< UTF-32
        double x = 0, y = 0;
    };
    void receive(Event event);
    /// Gives ImGui the input of one frame in its order. What would hide an earlier event waits for the next frame, so
    /// that a slow frame loses no click and no command.
    void giveInput();
    void giveHeld();

    GLFWwindow* window_ = nullptr;
    std::deque<Event> input_;  ///< not yet given
    InputCounters given_;
    bool stirred_ = true;
    bool outside_ = false;  ///< the pointer has left the window
    std::vector<std::filesystem::path> dropped_;
};

}  // namespace sgm::window
