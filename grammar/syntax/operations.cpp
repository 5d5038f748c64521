#include "grammar/syntax/operations.h"

#include <algorithm>
#include <array>

namespace sgm::syntax {

namespace {

using Type = ArgumentType;
using Argument = OperationArgument;

constexpr Argument sizeArguments[] = {
    {"size", Type::Size, "metres, shares of the scope, or (x, y, z) of them; one number serves all three axes"}};
constexpr Argument moveArguments[] = {
    {"offset", Type::Vector, "along x, y, z of the matched scope; bare numbers are metres"}};
constexpr Argument turnArguments[] = {
    {"angle", Type::Angle, "about y; (a, b, c) turns about x, then y, then z, through the centre"}};
constexpr Argument atArguments[] = {
    {"ours", Type::Joint, "our joint: a face, centre, a declared name, free(…) or the variable of 'for d in axes'"}};
constexpr Argument toArguments[] = {
    {"theirs", Type::Joint,
     "the newcomer's joint; the opposite face unless said; centre puts its centre on our joint"}};
constexpr Argument overlapArguments[] = {
    {"share", Type::Number, "how far the newcomer moves inward along the joint: 0 touches, 1 puts its centre there"}};
constexpr Argument shiftArguments[] = {
    {"shift", Type::Vector,
     "moves the mating point (S_J) along x, y, z of the matched scope: shares of the newcomer's half-size, or metres"}};
constexpr Argument onArguments[] = {
    {"host", Type::Shape,
     "last: the newest shape of the chain; any(d): one placed toward d in the step before; each(Name): all of that name"}};
constexpr Argument byArguments[] = {
    {"amount", Type::Number, "a of the morph (eq. 14): 0 keeps what stands, 1 gives the newcomer"}};
constexpr Argument blendArguments[] = {
    {"radius", Type::Length, "metres within which both surfaces melt; 0 is a sharp edge"}};
constexpr Argument displaceArguments[] = {
    {"noise", Type::Noise, "billow(amplitude, frequency) or fbm(amplitude, frequency [, octaves])"}};
constexpr Argument colorArguments[] = {{"color", Type::Color, "#rrggbb, or a parameter that holds one"}};
constexpr Argument roughArguments[] = {{"roughness", Type::Number, "0 is a mirror, 1 is chalk"}};
constexpr Argument metalArguments[] = {{"metalness", Type::Number, "0 is a dielectric, 1 is a metal"}};
constexpr Argument tagArguments[] = {{"tag", Type::Name, "a word"}};
constexpr Argument withArguments[] = {{"name", Type::Name, "the value's name, followed by '='"},
                                      {"value", Type::Number, "its value, of any type"}};
constexpr Argument splitArguments[] = {{"axis", Type::Axis, "x, y or z of the scope"}};
constexpr Argument insetArguments[] = {{"width", Type::Length, "metres from each edge of the face"}};
constexpr Argument cladArguments[] = {{"pattern", Type::Solid, "an ornament, a kifs, or a terminal that is one; its colour is the terminal's"}};
constexpr Argument thicknessArguments[] = {
    {"thickness", Type::Vector, "metres of the walls' cladding outside the inner solid, or two: of the walls and below the top"}};
constexpr Argument tileArguments[] = {{"period", Type::Vector, "metres after which the pattern repeats, along and up (bay and storey)"}};
constexpr Argument mirrorArguments[] = {{"r", Type::Vector, "three shares of half a bay, at which the pattern is folded one after the other"}};
constexpr Argument footprintArguments[] = {{"lsystem", Type::Name, "the lsystem that draws the outline"}};
constexpr Argument extrudeArguments[] = {{"height", Type::Length, "metres the outline is raised"}};
constexpr Argument roofArguments[] = {{"kind", Type::Name, "hip, gable or flat"},
                                      {"pitch", Type::Angle, "slope of its planes"},
                                      {"cover", Type::Solid, "the terminal it is made of", true}};
constexpr Argument balconyArguments[] = {{"depth", Type::Length, "metres it stands out from its wall"}};

using Id = Operation::Id;

constexpr std::array<Operation, 27> table = {{
    {Id::Size, "size", "Sets the size of the scope about its centre.", "cube size (12, 3.5, 9)", sizeArguments},
    {Id::Move, "move", "Moves the shape after it was placed.", "sphere move (0, 1.5, 0)", moveArguments},
    {Id::Turn, "turn", "Turns the shape about its own centre.", "cube turn 30deg", turnArguments},
    {Id::At, "at", "Names our joint at which the newcomer is mated; points meet, directions oppose (eq. 16).",
     "+ sphere at +x", atArguments},
    {Id::To, "to", "Names the newcomer's joint that is mated with ours.", "+ sphere at +x to centre", toArguments},
    {Id::Overlap, "overlap", "Lets the newcomer reach into its host.", "+ cube at +y overlap .2", overlapArguments},
    {Id::Shift, "shift", "Moves the mating point, the paper's joint shift S_J.",
     "+ sphere at +x to centre shift -.3..0.3", shiftArguments},
    {Id::On, "on", "Chooses the host among the shapes of a chain.", "+ sphere on last at +y", onArguments},
    {Id::By, "by", "Says how far a morph goes.", "morph torus by .2", byArguments},
    {Id::Blend, "blend", "Melts the newcomer, or the edge of a cut, into what stands.", "+ sphere at +x blend .25m", blendArguments},
    {Id::Displace, "displace", "Moves the surface along itself by noise.", "sphere displace billow(.05m, 2.2/m)",
     displaceArguments},
    {Id::Color, "color", "Sets the colour of the surface.", "cube color #c8b090", colorArguments},
    {Id::Rough, "rough", "Sets the roughness of the surface.", "cube rough .8", roughArguments},
    {Id::Metal, "metal", "Sets the metalness of the surface.", "cube metal 1", metalArguments},
    {Id::Tag, "tag", "Marks the shape with a word that rules and faces may ask for.", "cube tag K", tagArguments},
    {Id::With, "with", "Sets a value that the shape's descendants inherit.", "Level with storey = 3", withArguments},
    {Id::Split, "split",
     "Cuts the scope along an axis: sizes are absolute (4m), relative (30%) or floating (~1); { … }* repeats to fit.",
     "split x { 1m: wall | { ~2.4m: Tile }* | 1m: wall }", splitArguments, true, true},
    {Id::Inset, "inset", "Cuts a face into its rim and the rest.", "inset .12m { rim: frame | rest: glass }",
     insetArguments, true, false},
    {Id::Clad, "clad", "Dresses all that a shape holds: inner + (outer & pattern), where outer is what it holds and inner is that less the thickness.", "cube clad ornate thickness .4m",
     cladArguments},
    {Id::Thickness, "thickness", "How thick a cladding is.", "cube clad ornate thickness (.4m, .1m)", thicknessArguments},
    {Id::Tile, "tile", "Repeats a cladding.", "cube clad ornate tile (6m, 3m)", tileArguments},
    {Id::Mirror, "mirror", "Mirrors a cladding inside its tile.", "cube clad ornate mirror (.25, .125, .4)",
     mirrorArguments},
    {Id::Footprint, "footprint", "Takes the outline an lsystem draws as the shape's base.", "footprint Plan extrude 9m",
     footprintArguments, false, false},
    {Id::Extrude, "extrude", "Raises the base into a prism.", "footprint Plan extrude (floors * 3m)", extrudeArguments,
     false, false},
    {Id::Faces,
     "faces",
     "Gives the faces of a prism to bodies: side, top, bottom or a tag.",
     "faces { side: wall | top: roof hip 35deg tiles }",
     {},
     true,
     false},
    {Id::Roof, "roof", "Puts a roof on a top face.", "roof hip 35deg tiles", roofArguments, false, false},
    {Id::Balcony, "balcony", "Puts a balcony before a face.", "balcony 1.1m", balconyArguments, false, false},
}};

constexpr bool rowsFollowIds() {
    for (size_t i = 0; i < table.size(); ++i)
        if (static_cast<size_t>(table[i].id) != i) return false;
    return true;
}
static_assert(rowsFollowIds() && table.size() == static_cast<size_t>(Id::Balcony) + 1);

}  // namespace

std::span<const Operation> operations() { return table; }

const Operation* findOperation(std::string_view name) {
    const auto row = std::find_if(table.begin(), table.end(), [&](const Operation& o) { return o.name == name; });
    return row == table.end() ? nullptr : &*row;
}

}  // namespace sgm::syntax
