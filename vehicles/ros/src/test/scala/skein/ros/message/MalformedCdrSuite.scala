package skein.ros.message

class MalformedCdrSuite extends munit.FunSuite:
  test("of damaged messages each is read or refused with a reason, by seed"):
    val (read, refused) = MalformedCdr.read(20_000, seed = 1)
    assert(read > 500 && refused > 5_000, (read, refused))
