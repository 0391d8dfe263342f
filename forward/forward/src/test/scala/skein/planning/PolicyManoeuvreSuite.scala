package skein.planning

import skein.policy.{Course, TeamPolicy, TeamObservation}
import skein.vehicle.{PlaneReading, ReducedModel}

class PolicyManoeuvreSuite extends munit.FunSuite:
  private val own         = PredictedVehicle(ReducedModel.airSimAt(5), PlaneReading(1, 2, 3, 0))
  private val situation   = Situation(own, 0, 0.1, Vector.empty)
  private val observation =
    TeamObservation(0, IArray(1.0, 20.0), IArray(2.0, 0.0), IArray(3.0, 0.0), IArray(0.0, 5.0), 0, 0.1)
  private val limits = CommandLimits(0, 6, 4)

  private def flown(policy: TeamPolicy): Manoeuvre =
    PolicyManoeuvre.of(policy, observation, situation, limits, steps = 30, dtS = 0.1)

  test(
    "a course is turned to as fast as the limits allow, by the shorter way, and no faster than they allow"
  ):
    val manoeuvre = flown(_ => Course(-0.6, 9))
    assertEquals(manoeuvre.turnRates.take(3).toSeq, Seq(-4f, -2f, 0f))
    assertEquals(manoeuvre.speeds.toSeq.distinct, Seq(6f))

  test("the policy sees itself where it will be and the others straight on"):
    var seen               = Vector.empty[TeamObservation]
    val policy: TeamPolicy = at =>
      seen :+= at
      Course(0, 3)
    val manoeuvre = flown(policy)
    val track     = ManoeuvreRollout(situation, PlanCost(limits), 0.1).track(manoeuvre)
    assertEquals(seen.size, 30)
    assertEqualsDouble(seen(10).northM(0), track.x(9), 1e-9)
    assertEqualsDouble(seen(10).eastM(0), track.y(9), 1e-9)
    assertEqualsDouble(seen(10).eastM(1), 5.0, 1e-9)
