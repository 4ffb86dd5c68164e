// Tools that go by the colour of one Gaussian.
#include "app/tools/tool_hand.h"

namespace splatcut {

namespace {

template <class Select>
void click_colour(ToolHand& hand) {
  constexpr std::int32_t kNothing = -1;  // is refused with a word
  if (hand.state.right()) return;
  const auto point = hand.context.pick(hand.at_px);
  hand.ask(Select{point ? point->gaussian : kNothing, hand.operation()});
}

}  // namespace

constinit const Tool Tool::kColour = {
    .name = "Eyedropper: select by colour",
    .key = 'C',
    .sentence = "Click a colour in the picture: every Gaussian that has it is selected.",
    .icon =
        [] {
          return Icon{
              icon_loop({{0.35f, -0.9f}, {0.9f, -0.35f}, {0.55f, 0}, {0, -0.55f}}),
              icon_line({{0.15f, -0.35f}, {-0.75f, 0.5f}, {-0.9f, 0.9f}, {-0.5f, 0.75f}, {0.35f, -0.15f}})};
        },
    .selects = Selects::kColours,
    .click = click_colour<PickColour>,
};

constinit const Tool Tool::kFlood = {
    .name = "Flood: neighbours of one colour",
    .key = 'G',
    .sentence = "Click a spot: what hangs together with it and has its colour is selected.",
    .icon =
        [] {
          return Icon{icon_loop({{-0.15f, -0.8f}, {0.65f, 0}, {-0.15f, 0.8f}, {-0.95f, 0}}),
                      icon_line({{-0.95f, 0}, {0.65f, 0}}), icon_dot(0.82f, 0.6f, 0.2f)};
        },
    .selects = Selects::kColours,
    .click = click_colour<SelectFlood>,
};

}  // namespace splatcut
