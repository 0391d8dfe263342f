package skein.settings

import skein.forward.{QuadrotorResponse, SpatialResponse}
import skein.scenario.Scenarios

class VehicleChoiceSuite extends munit.FunSuite:
  private given Scenarios = Scenarios.ours

  private def parsed(text: String, altitudeM: Double = 20) = VehicleChoice.parse(text, altitudeM)

  test("a quadrotor and a tilting vehicle can deviate in mass, drag and lag, and in nothing else"):
    for (name, response) <- Seq("quadrotor" -> classOf[QuadrotorResponse], "tilt" -> classOf[SpatialResponse])
    do
      for deviation <- Seq("mass=1.3", "drag=2", "lag=1.5", "mass=1.3,drag=2,lag=1.5") do
        val found = parsed(s"$name:$deviation").fold(fail(_), identity)
        assertEquals(found.name, s"$name:$deviation")
        assert(response.isInstance(found.response), found.response)
        val usual = parsed(name).fold(fail(_), identity)
        assertNotEquals(found.response, usual.response)
        // As in flights, whose models do not know of it.
        assertEquals(found.response.predictor, usual.response.predictor)
      for deviation <- Seq("wind=1/0/0", "gusts=2", "shear=0.1", "rotors=1/1/1/0.9") do
        assertEquals(
          parsed(s"$name:$deviation"),
          Left(
            s"expected mass, drag and lag; wind, gusts, shear and rotors are for fly and spread, got '$name:$deviation'"
          )
        )

  test("the reduced model holds at the altitude where it was identified, and the others at any"):
    assertEquals(
      parsed("reduced", 5),
      Left("expected drag, quadrotor or a model file at 5.0 m altitude: reduced holds at 20.0 m")
    )
    for name <- Seq("drag", "quadrotor", "tilt", "ideal", "car") do
      assertEquals(parsed(name, 5).map(_.name), Right(name))

  test("vehicles that are simulated in steps of milliseconds are known"):
    val inSteps =
      Seq("reduced", "drag", "quadrotor", "tilt", "ideal", "car").filter(parsed(_).exists(_.fliesInSteps))
    assertEquals(inSteps, Seq("quadrotor"))

  test("a text that is neither a name nor a file is refused, with the names"):
    assert(clue(
      parsed("nosuch")
    ).left.exists(_.startsWith("expected reduced, drag, quadrotor, tilt, ideal, car, ")))
