"""A town of a hundred houses, for tests of baked cities."""
TOWN = """grammar 1
terminal lawn color #86a35f
terminal stone color #c8b090
start Town -> size (300, 4, 300) (lawn - sphere size (90, 20, 90) move (30, 8, -10), split x { { ~30m: Row }* })
rule Row -> split z { { ~30m: Plot }* }
rule Plot -> move (0, 6m, 0) size 8 turn (0deg..90deg) place House variety 5
start House -> stone size (8, 4m..9m, 6) - cube size (1, 2, 9) at -y to centre
"""
