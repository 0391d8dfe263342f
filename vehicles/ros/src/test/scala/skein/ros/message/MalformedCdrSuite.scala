package skein.ros.message

class MalformedCdrSuite extends munit.FunSuite:
  test("every damaged message is read, or refused with a reason"):
    val (read, refused) = MalformedCdr.read(20_000, seed = 1)
    assert(read > 500 && refused > 5_000, (read, refused))
