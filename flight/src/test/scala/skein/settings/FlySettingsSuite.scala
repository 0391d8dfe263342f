package skein.settings

import com.typesafe.config.ConfigFactory
import skein.units.Span

class FlySettingsSuite extends munit.FunSuite:

  private def read(text: String): Either[String, FlySettings] =
    FlySettings.read(ConfigFactory.parseString(text).withFallback(ConfigFactory.load()))

  test("a key that is not known is refused, with its line and the nearest that is"):
    val said = read(
      "skein.fly {\n  duration = 10 s\n  crossing { minimum = 3 }\n  durration = 5 s\n}"
    ).left.getOrElse("")
    assert(clue(said).contains("3: no setting 'skein.fly.crossing.minimum'; the nearest is 'minimum-m'"))
    assert(said.contains("4: no setting 'skein.fly.durration'; the nearest is 'duration'"))

  test("one name means one model, wherever it is named"):
    for name <- Seq("reduced", "drag", "quadrotor") do
      val plant = VehicleChoice.parse(name, 20).map(_.response.predictor)
      assertEquals(PredictionModel.parse(name).map(_.at(20)), plant)
    assert(clue(
      read("skein.fly.model = drag")
    ).left.exists(_.contains("no setting 'skein.fly.model' any more; it is 'predictor' now")))
    val high = read("skein.fly { predictor = reduced, altitude-m = 5 }")
    assert(clue(high).left.exists(_.contains("reduced holds at 20.0 m")))

  test("in a file, a key outside of skein.fly is refused, since nothing reads it"):
    val file = ConfigFactory.parseString("duration = 10 s\nskein { flyy { seed = 2 } }")
    val said = ConfigKeys.unknownInFile(file, "skein.fly").getOrElse("")
    assert(clue(said).contains("1: no setting 'duration'; the nearest is 'skein.fly'"))
    assert(said.contains("2: no setting 'skein.flyy'"))
    assertEquals(
      ConfigKeys.unknownInFile(ConfigFactory.parseString("skein.fly.planning.step = 50 ms"), "skein.fly"),
      None
    )

  test("a duration without a unit is refused, with a line that says so"):
    for text <- Seq("skein.fly.duration = 40", "skein.fly.duration = \"40\"") do
      val said = read(text).left.getOrElse("")
      assert(clue(said).contains("expected a duration with unit, such as 40s, came '40'"))

  test("a deadline is one where it is set"):
    assertEquals(read("").map(_.deadline), Right(None))
    assertEquals(read("skein.fly.deadline = 20 ms").map(_.deadline), Right(Some(Span.ofMillis(20))))

  test("the distance between words counts letters to change"):
    assertEquals(ConfigKeys.distance("durration", "duration"), 1)
    assertEquals(ConfigKeys.distance("", "loops"), 5)
    assertEquals(ConfigKeys.distance("seed", "period"), 4)
