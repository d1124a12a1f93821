"""Parses files of Structured Text with tree-sitter-iec61131-3-st; each of them, damaged, must be refused."""

import sys

import tree_sitter_iec61131_3_st
from tree_sitter import Language, Parser

PARSER = Parser(Language(tree_sitter_iec61131_3_st.language()))


def fault(node):
    """The first node that is wrong or missing."""
    if node.type == "ERROR" or node.is_missing:
        return node
    return next((found for child in node.children if child.has_error and (found := fault(child))), None)


count = broken = 0
for name in sys.argv[1:]:
    with open(name, "rb") as file:
        text = file.read()
    root = PARSER.parse(text).root_node
    if root.has_error or not root.children:
        node = fault(root) or root
        sys.exit(f"{name}: line {node.start_point[0] + 1}: {text[node.start_byte:node.end_byte][:200]}")
    count += 1
    broken += PARSER.parse(text.replace(b"END_IF;", b"", 1)).root_node.has_error
print(f"{count} files, {broken} refused when broken")
