package skein.margin

import skein.optimise.ScenarioTerm
import skein.scenario.{Measure, Scenario, Series, Tracks}
import skein.units.Vector3

/** The score of a run.
  *
  * @param unit may be empty
  */
enum MarginJudge(val name: String, val unit: String):
  /** The value in the last line that the program prints. */
  case Printed extends MarginJudge("the printed number", "")

  /** The number of contacts of all vehicles with objects of the scene. */
  case Contacts extends MarginJudge("contacts", "")

  /** A scenario's measure of the vehicles' true positions. */
  case Flown(measure: Measure) extends MarginJudge(measure.name, measure.unit)

object MarginJudge:
  private val Place = "distance:NORTH,EAST,DOWN"

  /** Reads `printed`, `contacts`, `separation`, `distance`, `distance:NORTH,EAST,DOWN` or the name of a
    * scenario's measure, with hyphens for blanks.
    *
    * @param scenario the scenario whose first measure is the default
    * @param vehicles number of vehicles
    * @return Left says what was expected, and the word
    */
  def read(
      text: Option[String],
      scenario: Option[Scenario],
      vehicles: Int
  ): Either[String, MarginJudge] =
    val own   = scenario.toVector.flatMap(_.measures)
    val names = own.map(ScenarioTerm.keyOf) ++ Vector("printed", "contacts", "separation", "distance", Place)
    def pair(measure: Measure) = Either.cond(
      vehicles >= 2,
      Flown(measure),
      s"expected two vehicles or more for ${text.getOrElse("")}, got $vehicles"
    )
    def expected(came: String) = Left(s"expected one of ${names.mkString(", ")}, got $came")
    text match
      case None       => own.headOption.fold(expected("nothing"))(first => Right(Flown(first)))
      case Some(word) =>
        own.find(ScenarioTerm.keyOf(_) == word).map(Flown(_)).map(Right(_)).getOrElse:
          word match
            case "printed"          => Right(Printed)
            case "contacts"         => Right(Contacts)
            case "separation"       => pair(separation.least("separation"))
            case "distance"         => pair(distance.mean("distance"))
            case s"distance:$place" => placeOf(place).map(to).map(Flown(_)).map(Right(_)).getOrElse(
                expected(s"'$word'")
              )
            case _ => expected(s"'$word'")

  private def placeOf(text: String): Option[Vector3] =
    text.split(",", -1).toVector.map(_.trim.toDoubleOption.filter(_.isFinite)) match
      case Vector(Some(north), Some(east), Some(down)) => Some(Vector3(north, east, down))
      case _                                           => None

  private val separation = Series("separation", "m"): tracks =>
    instant => tracks.vehicles.combinations(2).map(two => tracks.separationM(two(0), two(1), instant)).min

  private val distance = Series("distance", "m")(tracks => tracks.separationM(0, 1, _))

  private def to(place: Vector3): Measure =
    Series("distance to the place", "m")((tracks: Tracks) =>
      instant => (tracks.positionNed(0, instant) - place).norm
    )
      .mean("distance to the place")
