package skein.airsim

/** A kind of sensor, with its number in AirSim's settings. */
enum SensorKind(val number: Int):
  case Barometer    extends SensorKind(1)
  case Imu          extends SensorKind(2)
  case Gps          extends SensorKind(3)
  case Magnetometer extends SensorKind(4)
  case Distance     extends SensorKind(5)
  case Lidar        extends SensorKind(6)

object SensorKind:
  /** The sensors of an AirSim multirotor whose settings name none. */
  val Default: Map[String, SensorKind] =
    Map("imu" -> Imu, "magnetometer" -> Magnetometer, "gps" -> Gps, "barometer" -> Barometer)

  def of(number: Double): Option[SensorKind] = values.find(_.number.toDouble == number)

/** The sensors that a part of the settings lists.
  *
  * @param kinds the listed kinds
  * @param enabled those switched on, keyed by name
  */
final case class ListedSensors(
    kinds: Set[SensorKind] = Set.empty,
    enabled: Map[String, SensorKind] = Map.empty
):
  /** With those of `unless` for kinds of which none is listed. */
  def over(unless: Map[String, SensorKind]): Map[String, SensorKind] =
    unless.filterNot((_, kind) => kinds(kind)) ++ enabled
