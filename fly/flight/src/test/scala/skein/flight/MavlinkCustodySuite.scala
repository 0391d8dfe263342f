package skein.flight

class MavlinkCustodySuite extends munit.FunSuite:
  /** The result of the last of several checks, each with its set of vehicles that follow no setpoints. */
  private def found(lands: Set[String], taken: Set[String]*): Option[String] =
    var now     = Set.empty[String]
    val custody = MavlinkCustody(
      Vector("a", "b").map(name => (name, () => Option.when(now(name))(s"system of $name is disarmed"))),
      lands
    )
    taken.map { seen =>
      now = seen; custody.check()
    }.last

  test("vehicles that follow setpoints belong to the flight"):
    assertEquals(found(Set.empty, Set.empty, Set.empty), None)

  test("a vehicle that follows no setpoints is lost after two such checks in a row, with the reason"):
    assertEquals(found(Set.empty, Set("b")), None)
    assertEquals(found(Set.empty, Set("b"), Set.empty, Set("b")), None)
    assertEquals(found(Set.empty, Set("a"), Set("b")), None)
    assertEquals(
      found(Set.empty, Set("b"), Set("b")),
      Some("b is no longer this flight's: system of b is disarmed")
    )

  test("a vehicle that the flight itself lands is not lost"):
    assertEquals(found(Set("b"), Set("b"), Set("b")), None)
    assert(found(Set("b"), Set("a", "b"), Set("a", "b")).exists(_.startsWith("a is")))
