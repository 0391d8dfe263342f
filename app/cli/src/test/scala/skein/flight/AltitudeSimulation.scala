package skein.flight

import com.typesafe.config.ConfigFactory
import java.nio.file.{Files, Path}
import skein.loop.LoopKind
import skein.report.PaperReport
import skein.scenario.{PaperDuel, Scenarios}
import skein.search.Conditions
import skein.settings.{FlightPlan, FlySettings, PredictionModel}
import skein.signal.LatencyProfile
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.Span
import skein.vehicle.{ReducedModel, PlantModel, VehicleModel}

/** AirSim's vehicles lag more the higher they fly: a model is valid at one altitude. */
class AltitudeSimulation extends munit.FunSuite, Unhurried, TemporaryFolders:
  private given Scenarios = PaperReport.scenarios

  private def settings(hocon: String): Either[String, FlySettings] = FlySettings.read(
    ConfigFactory
      .parseString(hocon)
      .withFallback(ConfigFactory.load())
      .resolve()
  )

  /** The models that predict each vehicle's readings. */
  private def models(hocon: String): Set[VehicleModel[?]] =
    val read = settings(hocon).fold(fail(_), identity)
    read.fleet.agents.indices.map(read.loopSettings.model).toSet

  /** A model file, identified from flights at 20 m. */
  private val file = FunFixture[Path](
    _ =>
      Files.writeString(
        temporaryFolder().resolve("skein-model.conf"),
        """skein.model {
          |  use = drag
          |  altitude-m = 20
          |  drag { gain.value = 1, lag-s.value = 3, dead-time-s.value = 0.05, drag-per-m.value = 0.006 }
          |  lag { gain.value = 0.9, lag-s.value = 2.7, dead-time-s.value = 0.05 }
          |}""".stripMargin
      ),
    Files.delete
  )

  test("vehicles are predicted by the reduced model of their altitude"):
    def reduced(altitudeM: Double): Set[VehicleModel[?]] =
      Set(PlantModel(ReducedModel.airSimAt(altitudeM)))
    assertEquals(models("skein.fly.predictor = drag"), reduced(20))
    assertEquals(ReducedModel.airSimAt(20), ReducedModel.AirSim)
    assertEquals(models("skein.fly { predictor = drag, duel.altitude-m = 7 }"), reduced(7))
    assertEquals(models("skein.fly { predictor = drag, scenario = crossing }"), reduced(5))
    assertEquals(
      models("skein.fly { predictor = drag, scenario = surround, surround.altitude-m = 9 }"),
      reduced(9)
    )

  file.test("a model of flights at another altitude is refused, in flights and in forward simulation"):
    path =>
      val fine = s"skein.fly.predictor = \"$path\""
      assert(settings(fine).isRight, settings(fine))
      for hocon <- Seq("skein.fly.scenario = formation", "skein.fly.duel.altitude-m = 5") do
        val told = settings(s"$fine\n$hocon").left.getOrElse(fail(s"$hocon was taken"))
        assert(told.contains("flights at 5 m altitude") && told.contains("got one of 20 m"), told)
      for model <- Seq(path.toString, s"reduced:$path") do
        assert(Conditions("stream", model, 100, 60).resolved.isRight, model)
        val told = Conditions("stream", model, 100, 60, altitudeM = 5).resolved.left.getOrElse("")
        assert(told.startsWith("--plant") && told.contains("got one of 20 m"), told)

  test("forward simulation accepts an altitude, and reports which model is valid only at 20 m"):
    val told = Conditions("stream", "reduced", 100, 60, altitudeM = 5).resolved.left.getOrElse("")
    assert(told.contains("at 5.0 m altitude: reduced holds at 20.0 m"), told)
    for model <- Seq("drag", "quadrotor", "ideal") do
      val flown = Conditions("stream", model, 100, 60, altitudeM = 5).resolved.fold(fail(_), identity)
      assertEquals(flown.game.agents.head.altitudeDownM, -5.0)
      assertEquals(flown.paused.game.agents.last.altitudeDownM, -5.0)
    for wrong <- Seq(0.0, -5.0, 5000.0, Double.NaN) do
      val mistake = Conditions("stream", "drag", 100, 60, altitudeM = wrong).resolved.left.getOrElse("")
      assert(mistake.startsWith("--altitude: expected more than 0"), mistake)
      assert(settings(s"skein.fly.duel.altitude-m = \"$wrong\"").isLeft, wrong)

  test("at 5 m the model of this altitude predicts better than that of 20 m"):
    def errorM(model: PredictionModel): Double =
      val (loop, link) = (LoopKind.Predictive, LatencyProfile.vpn)
      val flown        = FlySettings(
        List(loop),
        List(link),
        Span.ofSeconds(15),
        Span.ofMillis(100),
        1,
        PaperDuel(altitudeM = 5),
        predictor = model
      )
      val errors = TappedFlight.fly(
        flown,
        FlightPlan("altitude", loop, link, 1)
      ).recording.predictions.map(_.error.value)
      errors.sorted.apply(errors.size / 2)
    val (here, there) =
      (errorM(PredictionModel.AirSimDrag), errorM(PredictionModel.Fitted(ReducedModel.AirSim)))
    assert(here < 0.5 * there, s"$here m and $there m")
