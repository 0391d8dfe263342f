package skein.environment

class ResumedSuite extends munit.FunSuite:
  test("a computation that failed fails again at each call, and none blocks"):
    val failing = Resumed: suspend =>
      suspend()
      throw IllegalStateException("no more")
    failing.goOn()
    failing.await()
    failing.goOn()
    for call <- Seq(() => failing.await(), () => failing.goOn(), () => failing.await()) do
      assertEquals(intercept[IllegalStateException](call()).getMessage, "no more")
    failing.close()
