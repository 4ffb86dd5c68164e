#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/tools/tool_hand.h"

namespace splatcut {

namespace {

Icon four_arrows() {
  Icon icon;
  for (int i = 0; i < 4; ++i) {
    const float c = std::cos(0.5f * glm::pi<float>() * static_cast<float>(i)),
                s = std::sin(0.5f * glm::pi<float>() * static_cast<float>(i));
    const auto turned = [&](float x, float y) { return glm::vec2(c * x - s * y, s * x + c * y); };
    icon.push_back(icon_line({turned(0.15f, 0), turned(1, 0)}));
    icon.push_back(icon_line({turned(0.7f, -0.28f), turned(1, 0), turned(0.7f, 0.28f)}));
  }
  return icon;
}

}  // namespace

constinit const Tool Tool::kNavigate = {
    .name = "Navigate",
    .key = '1',
    .sentence =
        "Left drag turns, right drag shifts, the wheel zooms. Double-click sets the point to turn around.",
    .icon = four_arrows,
    .double_click =
        [](ToolHand& hand) {
          if (const auto point = hand.context.pick(hand.at_px))
            hand.context.camera.focus(point->position_world);
        },
};

}  // namespace splatcut
