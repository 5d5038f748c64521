// The system's window with an OpenGL context and Dear ImGui in it.
// Enters: a title and a size. Leaves: events and frames. Assumes the main thread and one window.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "modeler/core/result.h"

struct GLFWwindow;

namespace sgm::viewer {

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
    bool stirred();
    /// Files dropped on the window since the last call.
    std::vector<std::filesystem::path> dropped();
    /// The person asked to close it, since the last call.
    bool closing();
    /// Keys wait for the next frame.
    bool pending() const { return !keys_.empty(); }
    /// Ends a `listen` from any thread.
    static void wake();

    void setTitle(const std::string& title);
    /// Between these two ImGui may be used; `endFrame` shows what it made.
    void beginFrame();
    void endFrame();
    /// Renderer and version, as the driver calls itself.
    std::string driver() const;

private:
    Window() = default;
    struct KeyEvent {
        int key;          ///< GLFW's
        bool down;
        unsigned letter;  ///< UTF-32 where it is a letter that was typed, else 0
    };
    /// Gives ImGui the keys of one frame, in their order: a command's press and release never fall into the same frame,
    /// however slow frames are.
    void giveKeys();

    GLFWwindow* window_ = nullptr;
    std::deque<KeyEvent> keys_;  ///< not yet given
    bool stirred_ = true;
    std::vector<std::filesystem::path> dropped_;
};

}  // namespace sgm::viewer
