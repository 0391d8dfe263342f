package skein.planning

import skein.policy.{Action, Observation, Policy, Seen}
import skein.signal.Kinematics
import skein.units.*
import skein.vehicle.{PlaneReading, ReducedModel}

class PolicyManoeuvreSuite extends munit.FunSuite:
  private val own         = PredictedVehicle(ReducedModel.airSimAt(5), PlaneReading(1, 2, 3, 0))
  private val situation   = Situation(own, 0, 0.1, Vector.empty)
  private val observation = Observation(
    0,
    Vector((1.0, 2.0, 3.0, 0.0), (20.0, 0.0, 0.0, 5.0)).map: (north, east, northMps, eastMps) =>
      val (place, velocity) = (Vector3(north, east, -5), Vector3(northMps, eastMps, 0))
      Seen(Kinematics(place, velocity, Quaternion.Identity, Vector3.Zero), Span.Zero, isPredicted = true)
    ,
    1,
    Vector(Radians(0), Radians(0)),
    Span.ofMillis(100),
    0,
    MetresPerSecond(6),
    Metres(-5)
  )
  private val limits = CommandLimits(0, 6, 4)

  /** Returns a given answer, and counts its decisions. */
  private final class Answering(answer: (Observation, Int) => Action) extends Policy:
    type Memory = Int
    def start: Int                                            = 0
    def choose(seen: Observation, memory: Int): (Action, Int) = (answer(seen, memory), memory + 1)

  private def flown(answer: (Observation, Int) => Action): Manoeuvre =
    PolicyManoeuvre.of(Answering(answer), 0, observation, situation, limits, steps = 30, dtS = 0.1)

  test("a vehicle turns towards a course by the shorter way, exactly as fast as the limits allow"):
    val manoeuvre = flown((seen, _) => seen.along(-0.6, 9))
    assertEquals(manoeuvre.turnRates.take(3).toSeq, Seq(-4f, -2f, 0f))
    assertEquals(manoeuvre.speeds.toSeq.distinct, Seq(6f))

  test("the policy observes its own future position, and the others on straight tracks"):
    var seen      = Vector.empty[Observation]
    val manoeuvre = flown: (at, asked) =>
      assertEquals(asked, seen.size)
      seen :+= at
      at.along(0, 3)
    val track = ManoeuvreRollout(situation, PlanCost(limits), 0.1).track(manoeuvre)
    assertEquals(seen.size, 30)
    assertEqualsDouble(seen(10).northM(0), track.x(9), 1e-9)
    assertEqualsDouble(seen(10).eastM(0), track.y(9), 1e-9)
    assertEqualsDouble(seen(10).eastM(1), 5.0, 1e-9)
