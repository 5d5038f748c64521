#include "viewer/window/window.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cfloat>
#include <utility>
#include <vector>

#include "viewer/window/style.h"

namespace sgm::window {
namespace {

Error cannotOpen(const char* fallback) {
    const char* why = nullptr;
    glfwGetError(&why);
    return {Error::Kind::Internal, std::string("no window can be opened: ") + (why ? why : fallback)};
}

Window& self(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

}  // namespace

Result<std::unique_ptr<Window>> Window::open(const std::string& title, int width, int height) {
    if (!glfwInit()) return cannotOpen("there is no display");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    GLFWwindow* made = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!made) {
        const Error error = cannotOpen("the driver offers no OpenGL 4.5");
        glfwTerminate();
        return error;
    }
    glfwSetWindowSizeLimits(made, 720, 480, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwMakeContextCurrent(made);
    glfwSwapInterval(1);
    std::unique_ptr<Window> window(new Window);
    window->window_ = made;
    glfwSetWindowUserPointer(made, window.get());
    // ImGui's callbacks, installed below, call these in turn.
    glfwSetCursorEnterCallback(made, [](GLFWwindow* w, int entered) {
        self(w).stirred_ = true;
        self(w).outside_ = !entered;
    });
    glfwSetWindowFocusCallback(made, [](GLFWwindow* w, int) { self(w).stirred_ = true; });
    glfwSetFramebufferSizeCallback(made, [](GLFWwindow* w, int, int) { self(w).stirred_ = true; });
    glfwSetWindowRefreshCallback(made, [](GLFWwindow* w) { self(w).stirred_ = true; });
    glfwSetDropCallback(made, [](GLFWwindow* w, int count, const char** paths) {
        self(w).stirred_ = true;
        self(w).dropped_.assign(paths, paths + count);
    });
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    float scaleX = 1, scaleY = 1;
    glfwGetWindowContentScale(made, &scaleX, &scaleY);
    dress(scaleX);
    ImGui_ImplGlfw_InitForOpenGL(made, true);
    // These replace ImGui's, which know the state at the frame alone.
    using Kind = Event::Kind;
    glfwSetKeyCallback(made, [](GLFWwindow* w, int key, int, int action, int) {
        if (key >= 0 && key < IM_ARRAYSIZE(ImGuiIO::KeysDown) && action != GLFW_REPEAT)
            self(w).receive({.kind = Kind::Key, .code = key, .down = action == GLFW_PRESS});
    });
    glfwSetCharCallback(
        made, [](GLFWwindow* w, unsigned letter) { self(w).receive({.kind = Kind::Letter, .letter = letter}); });
    glfwSetCursorPosCallback(
        made, [](GLFWwindow* w, double x, double y) { self(w).receive({.kind = Kind::Move, .x = x, .y = y}); });
    glfwSetMouseButtonCallback(made, [](GLFWwindow* w, int button, int action, int) {
        if (button >= 0 && button < ImGuiMouseButton_COUNT)
            self(w).receive({.kind = Kind::Button, .code = button, .down = action == GLFW_PRESS});
    });
    glfwSetScrollCallback(
        made, [](GLFWwindow* w, double x, double y) { self(w).receive({.kind = Kind::Wheel, .x = x, .y = y}); });
    glfwGetCursorPos(made, &window->given_.x, &window->given_.y);
    ImGui_ImplOpenGL3_Init("#version 430 core");
    ImGui_ImplOpenGL3_CreateDeviceObjects();  // letters and shaders: before anybody waits for an answer
    return window;
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

SharedContext::~SharedContext() { glfwDestroyWindow(hidden_); }
void SharedContext::take() const { glfwMakeContextCurrent(hidden_); }
void SharedContext::giveBack() const { glfwMakeContextCurrent(nullptr); }

Result<std::unique_ptr<SharedContext>> Window::share() const {
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    GLFWwindow* hidden = glfwCreateWindow(1, 1, "sgm worker", nullptr, window_);
    glfwWindowHint(GLFW_VISIBLE, GLFW_TRUE);
    if (!hidden) return cannotOpen("the driver offers no second context");
    return std::make_unique<SharedContext>(hidden);
}

void Window::listen(double seconds) { seconds > 0 ? glfwWaitEventsTimeout(seconds) : glfwPollEvents(); }
bool Window::hadInput() { return std::exchange(stirred_, false); }
std::vector<std::filesystem::path> Window::dropped() { return std::exchange(dropped_, {}); }
bool Window::closing() {
    const bool asked = glfwWindowShouldClose(window_);
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
    return asked;
}
void Window::notify() { glfwPostEmptyEvent(); }
void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::receive(Event event) {
    stirred_ = true;
    input_.push_back(event);
}

void Window::giveInput() {
    using Kind = Event::Kind;
    ImGuiIO& io = ImGui::GetIO();
    const auto either = [&](int left, int right) { return io.KeysDown[left] || io.KeysDown[right]; };
    const auto isModifier = [](int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; };
    bool command = false;  // a key that stands for more than its letter
    bool button = false;   // of the mouse; its wheel holds nothing up, for it turns while the pointer moves
    bool letters = false, moved = false;
    std::vector<int> turned;  // keys that went down or up
    /// False where the event must wait for the next frame.
    const auto give = [&](const Event& event) {
        // Whatever follows a command or a click might change what it means: a modifier let go, a pointer moved on.
        if (command || (button && event.kind != Kind::Wheel)) return false;
        switch (event.kind) {
            case Kind::Letter:
                io.AddInputCharacter(event.letter);
                letters = true;
                return true;
            case Kind::Move:
                given_.x = event.x;
                given_.y = event.y;
                moved = true;
                return true;
            case Kind::Button:
                // A tab takes a click only where the pointer was over it in the frame before.
                if (letters || !turned.empty() || (event.down && moved)) return false;
                given_.buttons = event.down ? given_.buttons | 1u << event.code : given_.buttons & ~(1u << event.code);
                button = true;
                return true;
            case Kind::Wheel:
                io.MouseWheelH += static_cast<float>(event.x);
                io.MouseWheel += static_cast<float>(event.y);
                given_.wheel += event.y;
                return true;
            case Kind::Key:
                break;
        }
        const bool isLetter = event.code < 256 && !either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
        // A text takes letters, so their keys may come and go; elsewhere they are commands and stay for a frame.
        const bool ofText = io.WantTextInput && (isLetter || isModifier(event.code));
        if (!ofText &&
            (event.down ? std::find(turned.begin(), turned.end(), event.code) != turned.end() : !turned.empty()))
            return false;
        const bool commands = event.down && !isLetter && !isModifier(event.code);
        if (commands && letters) return false;
        command = commands;
        turned.push_back(event.code);
        if (io.KeysDown[event.code] != event.down) event.down ? ++given_.keys : --given_.keys;
        if (!event.down) ++given_.releases;
        io.KeysDown[event.code] = event.down;
        return true;
    };
    while (!input_.empty() && give(input_.front())) input_.pop_front();
    if (!input_.empty()) stirred_ = true;
    giveHeld();
}

/// Modifiers, the pointer and its buttons as they are now.
void Window::giveHeld() {
    ImGuiIO& io = ImGui::GetIO();
    const auto either = [&](int left, int right) { return io.KeysDown[left] || io.KeysDown[right]; };
    io.KeyCtrl = either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    io.KeyShift = either(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    io.KeyAlt = either(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
    io.KeySuper = either(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
    // ImGui's own look at the pointer says whether it is ours at all, but not whether it has left a window with the
    // keys. A drag goes on outside.
    if (outside_ && given_.buttons == 0 && input_.empty())
        io.MousePos = {-FLT_MAX, -FLT_MAX};
    else if (ImGui::IsMousePosValid(&io.MousePos))
        io.MousePos = {static_cast<float>(given_.x), static_cast<float>(given_.y)};
    for (int i = 0; i < ImGuiMouseButton_COUNT; ++i) io.MouseDown[i] = given_.buttons >> i & 1;
}

void Window::beginFrame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    giveInput();
    ImGui::NewFrame();
    // A field that is entered again would keep what can be undone in it, though its text may be another now: undoing
    // that leaves the text's memory.
    ImGuiContext& context = *ImGui::GetCurrentContext();
    if (context.ActiveId != context.InputTextState.ID) context.InputTextState.ID = 0;
}

void Window::endFrame() {
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glClearColor(0.1f, 0.1f, 0.11f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window_);
    glClearColor(0, 0, 0, 0);
}

std::string Window::driver() const {
    const auto text = [](GLenum name) { return std::string(reinterpret_cast<const char*>(glGetString(name))); };
    return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

}  // namespace sgm::window
