package skein.ros.message

import skein.testing.Lengthy

class MillionMalformedSuite extends munit.FunSuite, Lengthy:
  test("each of a million damaged messages is read, or refused with a reason"):
    val (read, refused) = MalformedCdr.read(1_000_000, seed = 2)
    assertEquals(read + refused, 1_000_000)
