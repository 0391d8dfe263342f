package skein.policy

class PolicyFamilySuite extends munit.FunSuite:

  test("a family is found by its name, and an unknown name is answered with the known ones"):
    for family <- PolicyFamily.all do assertEquals(PolicyFamily.parse(family.name), Right(family))
    val mistake = PolicyFamily.parse("nosuch").left.getOrElse("")
    assert(mistake.contains("nosuch") && mistake.contains("paper-pursuer"), mistake)

  test("the paper's families have the paper's policies as their defaults"):
    assertEquals(PolicyFamily.paperPursuer.defaultPolicy, PaperPursuer())
    assertEquals(PolicyFamily.paperEvader.defaultPolicy, PaperEvader())

  test("a family refuses another number of parameters than it has"):
    val _ = intercept[IllegalArgumentException](PolicyFamily.paperPursuer.policy(Vector(1.0, 2.0)))
