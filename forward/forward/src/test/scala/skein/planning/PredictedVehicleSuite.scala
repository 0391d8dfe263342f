package skein.planning

import skein.vehicle.{ObservedPlant, PlaneReading, ReducedModel}

private final case class Headed(
    northM: Double,
    eastM: Double,
    northMps: Double,
    eastMps: Double,
    heading: Double
)

class PredictedVehicleSuite extends munit.FunSuite:

  private final class Lagging(lagS: Double) extends ObservedPlant[Headed]:
    def initial: Headed                   = Headed(0, 0, 0, 0, 0)
    def stepS: Double                     = 0.01
    def read(state: Headed): PlaneReading =
      PlaneReading(state.northM, state.eastM, state.northMps, state.eastMps)
    def corrected(state: Headed, seen: PlaneReading): Headed =
      Headed(seen.northM, seen.eastM, seen.northMps, seen.eastMps, state.heading)
    def step(state: Headed, northMps: Double, eastMps: Double, dtS: Double): Headed =
      val (north, east) =
        (
          state.northMps + (northMps - state.northMps) * dtS / lagS,
          state.eastMps + (eastMps - state.eastMps) * dtS / lagS
        )
      Headed(state.northM + north * dtS, state.eastM + east * dtS, north, east, state.heading)

  test("a vehicle is at its reading; missing parts of the state come from the known state, or from rest"):
    val at     = PlaneReading(100, -50, 3, 4)
    val known  = PredictedVehicle.of(Lagging(1), at, 1, Vector(9, 9, 9, 9, 0.7))
    val anyhow = PredictedVehicle.of(Lagging(1), at, 1)
    assertEquals((known.motion, anyhow.motion), (at, at))
    assertEquals((known.state.heading, anyhow.state.heading), (0.7, 0.0))

  test("a velocity carries a vehicle on for its lag, at any speed"):
    assertEquals(PredictedVehicle.carriesS(ReducedModel.AirSim, 10), ReducedModel.AirSim.lagS)
    for lagS <- Seq(0.3, 1.0); speed <- Seq(0.1, 8.0) do
      assertEqualsDouble(PredictedVehicle.carriesS(Lagging(lagS), speed), lagS, 0.011)
