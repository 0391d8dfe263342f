package skein.simulator

import skein.units.*
import upack.{Float32, Int32, Msg}

class PlanCallSuite extends munit.FunSuite:

  test("of every function that moves a vehicle, except hover, the duration or time limit is found"):
    for function <- MoveMethods.all if function.name != "hover" do
      val place = PlannedMove.limits.get(function.name)
      assert(place.exists(_ < function.arity - 1), s"${function.name}: $place")
    assertEquals(PlannedMove.limits.keySet -- MoveMethods.all.map(_.name), Set.empty[String])

  private def move(method: String, params: Msg*) =
    PlannedMove(Instant.Epoch + Span.ofSeconds(1), method, params.toVector)

  test("a move that begins late ends when planned, and one whose end has passed does not begin"):
    val flight = move("rotateByYawRate", Float32(10), Float32(2))
    assertEquals(flight.begun(Span.Zero), Some(flight))
    assertEquals(flight.begun(Span.ofMillis(500)), Some(move("rotateByYawRate", Float32(10), Float32(1.5f))))
    assertEquals(flight.begun(Span.ofSeconds(2)), None)
    assertEquals(move("takeoff", Int32(3)).begun(Span.ofSeconds(1)), Some(move("takeoff", Float32(2))))
    assertEquals(move("hover").begun(Span.ofSeconds(100)), Some(move("hover")))
    assertEquals(move("land", Float32(Float.MaxValue)).lasts, Span.ofSeconds(1e8))
