; Names of the captures are those that Neovim, Helix and Emacs share.
(comment) @comment
(string) @string
(color) @constant
(number) @number
(declaration) @keyword
(clause) @keyword
(operation) @function.builtin
(function) @function
(solid) @type.builtin
(plan) @type.builtin
(value) @constant.builtin
(operator) @operator
((name) @type (#match? @type "^[A-Z]"))
((name) @variable (#match? @variable "^[a-z_]"))
