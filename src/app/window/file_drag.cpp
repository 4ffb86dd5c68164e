#include "app/window/file_drag.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace splatcut {

namespace {

using Clock = std::chrono::steady_clock;
constexpr long kVersion = 5;

// A window may go while it is spoken to: Xlib's own handler would end the program.
class QuietErrors {
 public:
  explicit QuietErrors(Display* display)
      : display_(display), before_(XSetErrorHandler([](Display*, XErrorEvent*) { return 0; })) {}
  ~QuietErrors() {
    XSync(display_, 0);
    XSetErrorHandler(before_);
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  Display* display_;
  XErrorHandler before_;
};

}  // namespace

std::string file_uri(const std::filesystem::path& file) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string uri = "file://";
  for (const char c : file.string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (kPlain.find(c) != kPlain.npos)
      uri += c;
    else
      uri += {'%', kHex[byte / 16], kHex[byte % 16]};
  }
  return uri;
}

struct FileDrag::Source {
  explicit Source(std::string uri) : uris(std::move(uri) + "\r\n"), display(XOpenDisplay(nullptr)) {
    if (!display) return;
    window = XCreateSimpleWindow(display, DefaultRootWindow(display), -1, -1, 1, 1, 0, 0, 0);
    XSetSelectionOwner(display, atom("XdndSelection"), window, CurrentTime);
  }
  ~Source() {
    if (!display) return;
    XDestroyWindow(display, window);
    XCloseDisplay(display);
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  bool update();

 private:
  Atom atom(const char* name) const { return XInternAtom(display, name, 0); }
  template <class T>
  std::optional<T> number(Window of, Atom property, Atom type) const;
  Window taker_at(int x, int y) const;
  void send(const char* message, std::initializer_list<long> data) const;
  void go_to(Window taker);
  void offer(int x, int y);
  void release();
  void answer(const XEvent& event);
  void serve(const XSelectionRequestEvent& request) const;

  std::string uris;
  Display* display;
  Window window = 0, target = 0;  // target: of another program, under the pointer; 0: none
  std::optional<std::pair<int, int>> offered_at;
  bool waits = false, accepted = false;  // for the target's answer; what that was
  bool released = false, dropped = false, done = false;
  Clock::time_point give_up;  // once released
};

// Of a property with one 32-bit value, which Xlib gives as a long.
template <class T>
std::optional<T> FileDrag::Source::number(Window of, Atom property, Atom type) const {
  Atom actual = 0;
  int format = 0;
  unsigned long count = 0, left = 0;
  unsigned char* data = nullptr;
  const int failed =
      XGetWindowProperty(display, of, property, 0, 1, 0, type, &actual, &format, &count, &left, &data);
  std::optional<T> value;
  if (failed == 0 && data && format == 32 && count > 0)
    value = static_cast<T>(*reinterpret_cast<unsigned long*>(data));
  if (data) XFree(data);
  return value;
}

// The outermost window there that takes drops; 0 where it is this program's, or none.
Window FileDrag::Source::taker_at(int x, int y) const {
  const Window root = DefaultRootWindow(display);
  for (Window at = root;;) {
    Window child = 0;
    int in_x = 0, in_y = 0;
    if (!XTranslateCoordinates(display, root, at, x, y, &in_x, &in_y, &child) || child == 0) return 0;
    at = child;
    if (!number<long>(at, atom("XdndAware"), XA_ATOM)) continue;
    const auto process = number<long>(at, atom("_NET_WM_PID"), XA_CARDINAL);
    return process == static_cast<long>(::getpid()) ? 0 : at;
  }
}

void FileDrag::Source::send(const char* message, std::initializer_list<long> data) const {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.display = display;
  event.xclient.window = target;
  event.xclient.message_type = atom(message);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(window);
  std::ranges::copy(data, event.xclient.data.l + 1);
  XSendEvent(display, target, 0, NoEventMask, &event);
}

void FileDrag::Source::go_to(Window taker) {
  if (taker == target) return;
  if (target) send("XdndLeave", {});
  target = taker;
  waits = accepted = false;
  offered_at.reset();
  if (!target) return;
  const long theirs = number<long>(target, atom("XdndAware"), XA_ATOM).value_or(kVersion);
  send("XdndEnter", {std::min(kVersion, theirs) << 24, static_cast<long>(atom("text/uri-list"))});
}

void FileDrag::Source::offer(int x, int y) {
  if (!target || waits || offered_at == std::pair(x, y)) return;
  offered_at = {x, y};
  waits = true;
  send("XdndPosition",
       {0, static_cast<long>(x) << 16 | y, CurrentTime, static_cast<long>(atom("XdndActionCopy"))});
}

void FileDrag::Source::release() {
  constexpr auto kPatience = std::chrono::seconds(5);
  released = true;
  give_up = Clock::now() + kPatience;
}

void FileDrag::Source::serve(const XSelectionRequestEvent& request) const {
  XEvent reply{};
  XSelectionEvent& says = reply.xselection;
  says.type = SelectionNotify;
  says.display = display;
  says.requestor = request.requestor;
  says.selection = request.selection;
  says.target = request.target;
  says.time = request.time;
  says.property = request.property;
  const auto put = [&](Atom type, int format, const void* data, std::size_t count) {
    XChangeProperty(display, request.requestor, request.property, type, format, PropModeReplace,
                    static_cast<const unsigned char*>(data), static_cast<int>(count));
  };
  if (request.target == atom("text/uri-list") || request.target == atom("text/plain")) {
    put(request.target, 8, uris.data(), uris.size());
  } else if (request.target == atom("TARGETS")) {
    const Atom kinds[] = {atom("TARGETS"), atom("text/uri-list"), atom("text/plain")};
    put(XA_ATOM, 32, kinds, std::size(kinds));
  } else {
    says.property = 0;  // refused
  }
  XSendEvent(display, request.requestor, 0, NoEventMask, &reply);
}

void FileDrag::Source::answer(const XEvent& event) {
  if (event.type == SelectionRequest) return serve(event.xselectionrequest);
  if (event.type != ClientMessage || event.xclient.data.l[0] != static_cast<long>(target)) return;
  if (event.xclient.message_type == atom("XdndFinished")) done = true;
  if (event.xclient.message_type != atom("XdndStatus")) return;
  waits = false;
  accepted = event.xclient.data.l[1] & 1;
}

bool FileDrag::Source::update() {
  if (!display) return false;
  const QuietErrors quiet(display);
  while (XPending(display)) {
    XEvent event;
    XNextEvent(display, &event);
    answer(event);
  }
  if (released) {
    if (!waits && !dropped) {
      accepted ? send("XdndDrop", {0, CurrentTime}) : send("XdndLeave", {});
      dropped = accepted;
      done = !accepted;
    }
    return !done && Clock::now() < give_up;
  }
  Window root = 0, child = 0;
  int x = 0, y = 0, in_x = 0, in_y = 0;
  unsigned held = 0;
  XQueryPointer(display, DefaultRootWindow(display), &root, &child, &x, &y, &in_x, &in_y, &held);
  if (held & Button1Mask) {
    go_to(taker_at(x, y));
    offer(x, y);
    return true;
  }
  if (!target) return false;
  release();
  return true;
}

FileDrag::FileDrag() = default;
FileDrag::~FileDrag() = default;

void FileDrag::begin(const std::filesystem::path& file) {
  source_ = std::make_unique<Source>(file_uri(std::filesystem::absolute(file)));
}

bool FileDrag::update() {
  if (source_ && !source_->update()) source_.reset();
  return source_ != nullptr;
}

}  // namespace splatcut
