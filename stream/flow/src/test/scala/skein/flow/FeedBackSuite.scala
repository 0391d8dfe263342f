package skein.flow

class FeedBackSuite extends munit.FunSuite:

  test("a newer value replaces only the older value of its own key"):
    val held = Vector("a" -> 1, "b" -> 2)
    assertEquals(FeedBack.replace(held, "a" -> 3), Vector("b" -> 2, "a" -> 3))
    assertEquals(FeedBack.replace(held, "c" -> 3), Vector("a" -> 1, "b" -> 2, "c" -> 3))
