// Printed by `sgm reference --tree-sitter` from the parser's tables: the input of `tree-sitter generate`.
module.exports = grammar({
  name: "sgm",
  extras: () => [/\s/],
  word: ($) => $.name,
  rules: {
    source_file: ($) => repeat(choice($.comment, $.string, $.color, $.number, $.declaration, $.clause, $.operation, $.solid, $.function, $.plan, $.value, $.name, $.operator)),
    comment: () => token(/\/\/[^\n]*/),
    string: () => token(/"(\\["\\]|[^"\n])*"?/),
    color: () => token(/#[A-Za-z0-9_]*/),
    number: () => token(/(\d+(\.\d+)?|\.\d+)([eE][+-]?\d+)?(%|[A-Za-z0-9_]*)/),
    declaration: ($) => choice("use", "param", "let", "map", "material", "terminal", "start", "rule", "derive", "roads", "lsystem", "style", "check"),
    clause: ($) => choice("grammar", "in", "of", "group", "key", "joint", "facing", "beside", "when", "weight", "repeat", "finally", "for", "while", "choose", "distinct", "shuffled", "expect", "axiom", "morph", "and", "or", "not"),
    operation: ($) => choice("size", "move", "turn", "from", "at", "to", "overlap", "shift", "on", "by", "blend", "through", "displace", "color", "rough", "metal", "texture", "normals", "lay", "fitted", "walk", "report", "with", "footprint", "extrude", "offset", "setback", "court", "rectify", "inner", "tag", "split", "snap", "turtle", "row", "around", "faces", "network", "lots", "place", "variety", "clad", "thickness", "tile", "mirror"),
    solid: ($) => choice("cube", "sphere", "ellipsoid", "torus", "cylinder", "cone", "pyramid", "prism", "wedge", "capsule", "roof", "kifs", "mesh", "ornament", "block", "taperBlock", "shellBlock", "moulding", "corniceMoulding", "plinthMoulding", "stringMoulding", "sillMoulding", "gutterMoulding", "hipRoof", "gableRoof", "halfHipRoof", "mansardRoof", "gambrelRoof", "saltboxRoof", "shedRoof", "butterflyRoof", "flatRoof", "pyramidRoof", "domeRoof", "bellRoof", "halfspace"),
    function: ($) => choice("min", "max", "abs", "floor", "ceil", "round", "clamp", "sqrt", "sin", "cos", "tan", "atan2", "pow", "lerp", "if", "rotX", "rotY", "rotZ", "rgb", "bump", "fbm", "mean", "overlaps", "touches", "inside", "outlines", "value", "word", "count"),
    plan: ($) => choice("rect", "ell", "tee", "yard", "ring", "ngon", "arc"),
    value: ($) => choice("axes", "sides", "last", "any", "each", "free", "centre", "scope", "i", "nil", "true", "false", "pi", "x", "y", "z", "billow"),
    name: () => /[A-Za-z_][A-Za-z0-9_]*/,
    operator: () => token(/->|=>|~>|\.\.|==|!=|<=|>=|[-+*\/%&|:,=<>.~!(){}\[\];]/),
  },
});
