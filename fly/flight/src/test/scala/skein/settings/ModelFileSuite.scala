package skein.settings

import com.typesafe.config.ConfigFactory
import java.nio.file.Files
import skein.forecast.Structure
import skein.forward.PlantResponse
import skein.identify.{Fitted, HorizonError, Identification}
import skein.policy.{Axis, SearchSpace}
import skein.flight.FlightAssembler
import skein.scenario.Scenarios
import skein.solver.FlightDeciders
import skein.testing.TemporaryFolders
import skein.units.Expect
import skein.vehicle.*
import scala.jdk.CollectionConverters.*

/** A plant of a user's own that reaches its command immediately after a dead time. */
final case class Late(gain: Double, override val deadTimeS: Double) extends ObservedPlant[PlaneReading]:
  def initial: PlaneReading                                            = PlaneReading(0, 0, 0, 0)
  def stepS: Double                                                    = 0.1
  def read(state: PlaneReading): PlaneReading                          = state
  def corrected(state: PlaneReading, seen: PlaneReading): PlaneReading = seen
  def step(from: PlaneReading, northMps: Double, eastMps: Double, dtS: Double): PlaneReading =
    val (north, east) = (gain * northMps, gain * eastMps)
    PlaneReading(from.northM + north * dtS, from.eastM + east * dtS, north, east)

/** Arithmetic on the time of day: not a formula. */
object Fickle extends ObservedPlant[PlaneReading]:
  def initial: PlaneReading                                            = PlaneReading(0, 0, 0, 0)
  def stepS: Double                                                    = 0.1
  def read(state: PlaneReading): PlaneReading                          = state
  def corrected(state: PlaneReading, seen: PlaneReading): PlaneReading = seen
  def step(from: PlaneReading, northMps: Double, eastMps: Double, dtS: Double): PlaneReading =
    from.copy(northM = System.nanoTime.toDouble)

class ModelFileSuite extends munit.FunSuite, TemporaryFolders:
  private val late = Structure(
    "late",
    SearchSpace(Vector(Axis("gain", 0, 2), Axis("dead-time-s", 0, 1))),
    values => Late(values(0), values(1))
  )
  private given scenarios: Scenarios = Scenarios(Scenarios.ours.kinds, ownStructures = Vector(late))

  private def fit(structure: Structure, values: Double*): Fit =
    val fitted =
      structure.names.zip(values).map((name, value) => Fitted(name, value, value - 1, value + 1, false))
    val found = Identification(
      structure,
      fitted,
      structure.plant(values.toVector),
      100,
      9,
      0.1,
      0.2,
      isConverged = true
    )
    Fit(
      found,
      Vector(HorizonError(1, 9, 0.1, 0.2, 0.3, 0.4)),
      Vector(HorizonError(1, 50, 0.1, 0.2, 0.3, 0.4))
    )

  private def text(use: Structure): String = ModelFile.render(
    use,
    Vector(fit(Structure.Lag, 0.9, 2, 0.1), fit(late, 0.75, 0.25)),
    ModelFile.Provenance(Vector("one.duckdb"), Vector("Red"), 2, "1", altitudeM = Some(5))
  )

  test("a file of a user's own structure is read back, for simulation and for prediction"):
    val path = Files.writeString(temporaryFolder().resolve("model.conf"), text(late)).toString
    val file = ModelFile.read(path).fold(fail(_), identity)
    assertEquals(file.use, late)
    assertEquals(file.plant, Late(0.75, 0.25))
    assertEquals(file.reduced.map(_.gain), Some(0.9))
    val predictor = PredictionModel.parse(path)
    assertEquals(predictor, Right(PredictionModel.Own(late, Vector(0.75, 0.25))))
    assertEquals(predictor.map(_.at(20)), Right(PlantModel(Late(0.75, 0.25))))
    assertEquals(VehicleChoice.parse(path, 20).map(_.response), Right(PlantResponse(Late(0.75, 0.25))))

  test("a file has tables only of errors that were measured"):
    val both                = fit(late, 0.75, 0.25)
    def tables(fitted: Fit) =
      val written = ModelFile.render(late, Vector(fitted), ModelFile.Provenance(Vector(), Vector(), 1, "v"))
      ConfigFactory.parseString(
        written
      ).getConfig("skein.model.late").root.keySet.asScala.filter(_.startsWith("against"))
    assertEquals(tables(both).toSet, Set("against-quadrotor", "against-readings"))
    assertEquals(tables(both.copy(againstQuadrotor = Vector.empty)).toSet, Set("against-readings"))
    assertEquals(tables(both.copy(againstReadings = Vector.empty)).toSet, Set("against-quadrotor"))

  test("only models of Skein's structures are limited to the altitude of their flights"):
    def altitude(use: Structure) = ModelFile.parse(text(use), "model.conf").map(_.altitudeM)
    assertEquals(altitude(Structure.Lag), Right(Some(5.0)))
    assertEquals(altitude(late), Right(None))

  test("a recording keeps the structure of its predictor, with its values"):
    val model = PredictionModel.Own(late, Vector(0.1 + 0.2, 0.25))
    assertEquals(PredictionModel.recorded(PredictionModel.text(model)), Some(model))
    assertEquals(PredictionModel.recorded(PredictionModel.text(model))(using Scenarios.ours), None)
    assertEquals(PredictionModel.recorded("late 0.5"), None)

  test("a program that does not know the structure lists those that it knows"):
    val said = ModelFile.parse(text(late), "model.conf")(using Scenarios.ours)
    assertEquals(
      said.left.toOption,
      Some("model.conf: use: expected a structure (lag, turn, drag, drag-and-turn), got 'late'")
    )

  test("no structure or parameter may have the name of a key of model files"):
    val section                              = ConfigFactory.parseString(text(late)).getConfig("skein.model")
    def keys(of: com.typesafe.config.Config) = of.root.keySet.asScala.toSet
    def refused(label: String, name: String) =
      val space = SearchSpace(Vector(Axis(name, 0, 2)))
      Expect.refused(intercept[IllegalArgumentException](Structure(label, space, _ => Fickle)))
    for key <- keys(section) -- Seq("lag", "late") do
      assertEquals(
        refused(key, "gain"),
        s"expected another label of a structure: '$key' is a key of model files"
      )
    for key <- keys(section.getConfig("late")) -- late.names do
      assertEquals(
        refused("mine", key),
        s"structure mine: expected another name of a parameter: '$key' is a key of model files"
      )

  test("plans use a user's own plant if it is a formula; any other plant is refused before the flight"):
    val path = Files.writeString(temporaryFolder().resolve("model.conf"), text(late)).toString
    def read(loop: String, plant: ObservedPlant[?]) =
      val known = Structure("late", late.space, _ => plant)
      val flags = ConfigFactory.parseString(
        s"""skein.fly { loops = [$loop], links = [none], predictor = "$path" }"""
      )
      given Scenarios = scenarios.copy(ownStructures = Vector(known))
      FlySettings.read(flags.withFallback(ConfigFactory.load()))
    val settings = read("plan", Late(0.75, 0.25)).fold(fail(_), identity)
    assertEquals(settings.loopSettings.model(0), PlantModel(Late(0.75, 0.25)))
    val said = read("plan", Fickle).left.getOrElse("accepted")
    assert(
      said.contains("predictor: Pursuer: plans are flown with SIMD, and the vehicle is no formula: "),
      said
    )
    assert(read("predictive", Fickle).isRight)
    // Elsewhere, too.
    val fickle = PredictionModel.Own(Structure("late", late.space, _ => Fickle), Vector(0.75, 0.25))
    val flown  = RecordedPlan(settings.copy(predictor = fickle), settings.plans.head)
    assert(FlightDeciders.of(flown, FlightAssembler.counted).isLeft)
