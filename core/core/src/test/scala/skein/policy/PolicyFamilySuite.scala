package skein.policy

class PolicyFamilySuite extends munit.FunSuite:

  test("a family is found by its name, and the message about an unknown name lists the known ones"):
    for family <- PolicyFamily.all do assertEquals(PolicyFamily.parse(family.name), Right(family))
    val mistake = PolicyFamily.parse("nosuch").left.getOrElse("")
    assert(mistake.contains("nosuch") && mistake.contains("paper-pursuer"), mistake)

  test("the default policies of the paper's families are the paper's"):
    assertEquals(PolicyFamily.paperPursuer.defaultPolicy, PaperPursuer())
    assertEquals(PolicyFamily.paperEvader.defaultPolicy, PaperEvader())

  test("a family refuses a wrong number of parameters"):
    val _ = intercept[IllegalArgumentException](PolicyFamily.paperPursuer.policy(Vector(1.0, 2.0)))
