// What a desktop does to the window. A file manager that drops a file: the source's side of the XDND protocol, version
// 5 (freedesktop.org); a window manager whose button for closing is pressed.
#include "tests/window/simulated_user.h"

#include <chrono>
#include <thread>

// Its macros would break what comes behind them.
#include <X11/Xlib.h>

namespace sgm::window::test {
namespace {

/// The first window below `from` that takes drops; 0 for none.
::Window takerBelow(Display* display, ::Window from, Atom aware) {
    Atom type = 0;
    int format = 0;
    unsigned long count = 0, rest = 0;
    unsigned char* data = nullptr;
    XGetWindowProperty(display, from, aware, 0, 1, False, AnyPropertyType, &type, &format, &count, &rest, &data);
    if (data) XFree(data);
    XWindowAttributes attributes;
    XGetWindowAttributes(display, from, &attributes);
    if (type != None && attributes.map_state == IsViewable) return from;
    ::Window root = 0, parent = 0, *children = nullptr, found = 0;
    unsigned n = 0;
    XQueryTree(display, from, &root, &parent, &children, &n);
    for (unsigned i = 0; i < n && !found; ++i) found = takerBelow(display, children[i], aware);
    if (children) XFree(children);
    return found;
}

class Source {
public:
    Source(Display* display, std::string uris) : display_(display), uris_(std::move(uris)) {
        window_ = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
        XSetSelectionOwner(display_, atom("XdndSelection"), window_, CurrentTime);
        target_ = takerBelow(display_, DefaultRootWindow(display_), atom("XdndAware"));
    }
    /// True when the target says that it has taken the drop.
    bool drop(int x, int y) {
        if (!target_) return false;
        send("XdndEnter", 5L << 24, static_cast<long>(atom("text/uri-list")), 0, 0);
        send("XdndPosition", 0, static_cast<long>(x) << 16 | y, CurrentTime, static_cast<long>(atom("XdndActionCopy")));
        if (!waitFor("XdndStatus")) return false;
        send("XdndDrop", 0, CurrentTime, 0, 0);
        return waitFor("XdndFinished");
    }

private:
    Atom atom(const char* name) { return XInternAtom(display_, name, False); }
    void send(const char* type, long a, long b, long c, long d) {
        XEvent event{};
        event.xclient.type = ClientMessage;
        event.xclient.window = target_;
        event.xclient.message_type = atom(type);
        event.xclient.format = 32;
        const long words[5] = {static_cast<long>(window_), a, b, c, d};
        std::copy(words, words + 5, event.xclient.data.l);
        XSendEvent(display_, target_, False, NoEventMask, &event);
        XFlush(display_);
    }
    /// Gives what is asked for meanwhile.
    bool waitFor(const char* type) {
        for (int tries = 0; tries < 1000; ++tries) {
            while (XPending(display_)) {
                XEvent event;
                XNextEvent(display_, &event);
                if (event.type == SelectionRequest) give(event.xselectionrequest);
                if (event.type == ClientMessage && event.xclient.message_type == atom(type)) return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }
    void give(const XSelectionRequestEvent& asked) {
        XChangeProperty(display_, asked.requestor, asked.property, asked.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(uris_.data()), static_cast<int>(uris_.size()));
        XEvent answer{};
        answer.xselection.type = SelectionNotify;
        answer.xselection.requestor = asked.requestor;
        answer.xselection.selection = asked.selection;
        answer.xselection.target = asked.target;
        answer.xselection.property = asked.property;
        answer.xselection.time = asked.time;
        XSendEvent(display_, asked.requestor, False, NoEventMask, &answer);
        XFlush(display_);
    }

    Display* display_;
    std::string uris_;
    ::Window window_ = 0, target_ = 0;
};

}  // namespace

void SimulatedUser::dropFile(const std::filesystem::path& file) {
    Display* display = XOpenDisplay(display_.c_str());
    ASSERT_NE(display, nullptr);
    EXPECT_TRUE(Source(display, "file://" + file.string() + "\r\n").drop(640, 400)) << "the window takes no drop";
    XCloseDisplay(display);
    settled();
}

void SimulatedUser::requestClose() {
    Display* display = XOpenDisplay(display_.c_str());
    ASSERT_NE(display, nullptr);
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = takerBelow(display, DefaultRootWindow(display), XInternAtom(display, "XdndAware", False));
    event.xclient.message_type = XInternAtom(display, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display, "WM_DELETE_WINDOW", False));
    XSendEvent(display, event.xclient.window, False, NoEventMask, &event);
    XFlush(display);
    XCloseDisplay(display);
}

}  // namespace sgm::window::test
