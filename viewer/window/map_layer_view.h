// Maps of a grammar over the view: a coloured sheet over the ground.
// Enters: the workbench. Leaves: quads in ImGui's draw list. Assumes a frame of ImGui.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "grammar/derive/map_layer.h"
#include "viewer/document/session.h"

namespace sgm::window {

class Workbench;
struct Projection;

class MapLayerView {
public:
    /// A choice among the maps of the model's grammar and none of them. False, with nothing drawn, where it has none.
    bool choose(Workbench& bench);
    /// The chosen map over the ground, with its least and greatest value or its words.
    void draw(Workbench& bench, const Projection& project, ImDrawList& list);
    /// What is chosen; "" for none.
    const std::string& chosen() const { return chosen_; }

private:
    ImU32 colorOf(float value) const;
    void legend(const Projection& project, ImDrawList& list) const;

    std::string chosen_;  ///< a map by its name, which outlives models
    derive::MapLayer layer_;
    double height_m_ = 0;                              ///< of the sheet
    std::weak_ptr<const document::BuiltModel> shown_;  ///< the model that the layer is of
};

}  // namespace sgm::window
