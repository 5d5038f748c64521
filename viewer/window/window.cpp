#include "viewer/window/window.h"

#include <epoxy/gl.h>
// GLFW comes after epoxy, which brings the GL declarations.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "viewer/window/style.h"

namespace sgm::viewer {
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
    glfwSetMouseButtonCallback(made, [](GLFWwindow* w, int, int, int) { self(w).stirred_ = true; });
    glfwSetScrollCallback(made, [](GLFWwindow* w, double, double) { self(w).stirred_ = true; });
    glfwSetCursorPosCallback(made, [](GLFWwindow* w, double, double) { self(w).stirred_ = true; });
    glfwSetCursorEnterCallback(made, [](GLFWwindow* w, int) { self(w).stirred_ = true; });
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
    glfwSetKeyCallback(made, [](GLFWwindow* w, int key, int, int action, int) {
        self(w).stirred_ = true;
        if (key >= 0 && key < IM_ARRAYSIZE(ImGuiIO::KeysDown) && action != GLFW_REPEAT) self(w).keys_.push_back({key, action == GLFW_PRESS, 0});
    });
    glfwSetCharCallback(made, [](GLFWwindow* w, unsigned letter) {
        self(w).stirred_ = true;
        self(w).keys_.push_back({0, true, letter});
    });
    ImGui_ImplOpenGL3_Init("#version 430 core");
    return window;
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::listen(double seconds) { seconds > 0 ? glfwWaitEventsTimeout(seconds) : glfwPollEvents(); }
bool Window::stirred() { return std::exchange(stirred_, false); }
std::vector<std::filesystem::path> Window::dropped() { return std::exchange(dropped_, {}); }
bool Window::closing() {
    const bool asked = glfwWindowShouldClose(window_);
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
    return asked;
}
void Window::wake() { glfwPostEmptyEvent(); }
void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::giveKeys() {
    ImGuiIO& io = ImGui::GetIO();
    bool command = false;    // a key that stands for more than its letter: what follows belongs to the next frame
    std::vector<int> seen;   // went down in this frame
    const auto isModifier = [](int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; };
    while (!keys_.empty()) {
        const KeyEvent event = keys_.front();
        if (event.letter != 0) {
            if (command) break;
            io.AddInputCharacter(event.letter);
        } else if (event.down) {
            if (command) break;
            const bool isLetter = event.key < 256 && !io.KeysDown[GLFW_KEY_LEFT_CONTROL] && !io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
            command = !isLetter && !isModifier(event.key);
            seen.push_back(event.key);
            io.KeysDown[event.key] = true;
        } else {
            // A text takes letters, so their keys may come and go; elsewhere they are commands and stay down for a frame.
            const bool letterOfText = io.WantTextInput && event.key < 256;
            if (!letterOfText && std::find(seen.begin(), seen.end(), event.key) != seen.end()) break;
            io.KeysDown[event.key] = false;
        }
        keys_.pop_front();
    }
    if (!keys_.empty()) stirred_ = true;
    const auto either = [&](int left, int right) { return io.KeysDown[left] || io.KeysDown[right]; };
    io.KeyCtrl = either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    io.KeyShift = either(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    io.KeyAlt = either(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
    io.KeySuper = either(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
}

void Window::beginFrame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    giveKeys();
    ImGui::NewFrame();
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

}  // namespace sgm::viewer
