// Symbols of the tools: the icon font has none for lasso, polygon, sphere and ground.
#include <array>
#include <cmath>

#include "app/ui/widgets.h"

namespace splatcut {

namespace {

constexpr float kPi = 3.14159265f;

struct Pen {
  ImDrawList& list;
  ImVec2 centre;
  float radius;
  ImU32 colour;
  float line = 1.6f;

  ImVec2 at(float x, float y) const { return {centre.x + x * radius, centre.y + y * radius}; }
  void stroke(std::initializer_list<ImVec2> points, bool closed = false) const {
    for (const ImVec2& p : points) list.PathLineTo(at(p.x, p.y));
    list.PathStroke(colour, closed ? ImDrawFlags_Closed : 0, line);
  }
  void dot(float x, float y, float r) const { list.AddCircleFilled(at(x, y), r * radius, colour); }
  void ring(float x, float y, float r) const { list.AddCircle(at(x, y), r * radius, colour, 0, line); }
  void dashes(std::initializer_list<ImVec2> points) const {
    for (auto p = points.begin(); p + 1 < points.end(); ++p) {
      const ImVec2 a = *p, b = *(p + 1);
      for (int i = 0; i < 3; ++i) {
        const float s = static_cast<float>(i) / 3 + 0.06f, t = s + 0.2f;
        stroke(
            {{a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)}, {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}});
      }
    }
  }
};

void navigate_icon(const Pen& pen) {
  for (int i = 0; i < 4; ++i) {
    const float c = std::cos(0.5f * kPi * static_cast<float>(i)),
                s = std::sin(0.5f * kPi * static_cast<float>(i));
    const auto turned = [&](float x, float y) { return ImVec2(c * x - s * y, s * x + c * y); };
    pen.stroke({turned(0.15f, 0), turned(1, 0)});
    pen.stroke({turned(0.7f, -0.28f), turned(1, 0), turned(0.7f, 0.28f)});
  }
}

void click_icon(const Pen& pen) {
  pen.stroke({{-0.25f, -0.3f}, {0.75f, 0.25f}, {0.25f, 0.38f}, {0.05f, 0.9f}}, true);
  for (const float angle : {-2.7f, -2.1f, -1.5f})
    pen.stroke({{-0.32f + 0.35f * std::cos(angle), -0.36f + 0.35f * std::sin(angle)},
                {-0.32f + 0.68f * std::cos(angle), -0.36f + 0.68f * std::sin(angle)}});
}

void scribble_icon(const Pen& pen) {
  for (int i = 0; i <= 24; ++i) {
    const float t = static_cast<float>(i) / 24;
    pen.list.PathLineTo(pen.at(-0.9f + 1.8f * t, 0.55f * std::sin(t * 2.6f * kPi) * (1 - 0.3f * t)));
  }
  pen.list.PathStroke(pen.colour, 0, pen.line + 0.8f);
}

void brush_icon(const Pen& pen) {
  pen.stroke({{0.9f, -0.9f}, {0.05f, 0.05f}});
  pen.stroke({{0.05f, -0.2f}, {-0.55f, 0.25f}, {-0.85f, 0.85f}, {-0.2f, 0.6f}, {0.25f, 0}}, true);
}

void lasso_icon(const Pen& pen) {
  for (int i = 0; i < 26; ++i) {
    const float t = 2 * kPi * static_cast<float>(i) / 26;
    pen.list.PathLineTo(pen.at(0.9f * std::cos(t), -0.2f + 0.58f * std::sin(t) + 0.1f * std::sin(3 * t)));
  }
  pen.list.PathStroke(pen.colour, ImDrawFlags_Closed, pen.line);
  pen.stroke({{-0.5f, 0.3f}, {-0.6f, 0.6f}, {-0.35f, 0.95f}});
}

void polygon_icon(const Pen& pen) {
  const std::array<ImVec2, 4> corners = {ImVec2(-0.75f, 0.7f), ImVec2(-0.6f, -0.55f), ImVec2(0.55f, -0.75f),
                                         ImVec2(0.75f, 0.45f)};
  pen.stroke({corners[0], corners[1], corners[2], corners[3]}, true);
  for (const ImVec2& c : corners) pen.dot(c.x, c.y, 0.2f);
}

void sphere_icon(const Pen& pen) {
  pen.ring(0, 0, 0.9f);
  for (int i = 0; i <= 20; ++i) {
    const float t = kPi * static_cast<float>(i) / 20;
    pen.list.PathLineTo(pen.at(0.9f * std::cos(t), 0.3f * std::sin(t)));
  }
  pen.list.PathStroke(pen.colour, 0, pen.line);
}

void volume_icon(const Pen& pen) {
  pen.stroke({{0, -0.95f}, {0.85f, -0.5f}, {0.85f, 0.5f}, {0, 0.95f}, {-0.85f, 0.5f}, {-0.85f, -0.5f}}, true);
  pen.stroke({{-0.85f, -0.5f}, {0, 0}, {0.85f, -0.5f}});
  pen.stroke({{0, 0}, {0, 0.95f}});
}

void dropper_icon(const Pen& pen) {
  pen.stroke({{0.35f, -0.9f}, {0.9f, -0.35f}, {0.55f, 0}, {0, -0.55f}}, true);
  pen.stroke({{0.15f, -0.35f}, {-0.75f, 0.5f}, {-0.9f, 0.9f}, {-0.5f, 0.75f}, {0.35f, -0.15f}});
}

void flood_icon(const Pen& pen) {
  pen.stroke({{-0.15f, -0.8f}, {0.65f, 0}, {-0.15f, 0.8f}, {-0.95f, 0}}, true);
  pen.stroke({{-0.95f, 0}, {0.65f, 0}});
  pen.dot(0.82f, 0.6f, 0.2f);
}

void measure_icon(const Pen& pen) {
  pen.stroke({{-0.95f, 0.45f}, {0.45f, -0.95f}, {0.95f, -0.45f}, {-0.45f, 0.95f}}, true);
  for (const float t : {-0.45f, 0.0f, 0.45f})
    pen.stroke({{-0.25f + t, -0.25f - t}, {-0.02f + t, -0.02f - t}});
}

void ground_icon(const Pen& pen) {
  pen.stroke({{-1, 0.55f}, {-0.3f, 0.15f}, {1, 0.35f}, {0.3f, 0.85f}}, true);
  pen.stroke({{0, 0.5f}, {0, -0.9f}});
  pen.stroke({{-0.25f, -0.6f}, {0, -0.9f}, {0.25f, -0.6f}});
}

}  // namespace

void draw_tool_icon(ImDrawList& list, Tool tool, const ImVec2& centre, float radius, ImU32 colour) {
  const Pen pen{list, centre, radius, colour};
  switch (tool) {
    case Tool::kNavigate:
      return navigate_icon(pen);
    case Tool::kClick:
      return click_icon(pen);
    case Tool::kScribble:
      return scribble_icon(pen);
    case Tool::kBox:
      pen.stroke({{-0.9f, -0.75f}, {0.9f, -0.75f}, {0.9f, 0.75f}, {-0.9f, 0.75f}}, true);
      return pen.dot(0, 0, 0.32f);
    case Tool::kBrush:
      return brush_icon(pen);
    case Tool::kLasso:
      return lasso_icon(pen);
    case Tool::kRectangle:
      return pen.dashes({{-0.9f, -0.75f}, {0.9f, -0.75f}, {0.9f, 0.75f}, {-0.9f, 0.75f}, {-0.9f, -0.75f}});
    case Tool::kPolygon:
      return polygon_icon(pen);
    case Tool::kSphere:
      return sphere_icon(pen);
    case Tool::kVolume:
      return volume_icon(pen);
    case Tool::kColour:
      return dropper_icon(pen);
    case Tool::kFlood:
      return flood_icon(pen);
    case Tool::kGround:
      return ground_icon(pen);
    case Tool::kMeasure:
      return measure_icon(pen);
  }
}

}  // namespace splatcut
