package skein.autopilot

import skein.mavlink.*
import skein.units.*
import skein.units.Decimals.fixed

/** A mission with its progress.
  *
  * @param current the item it flies to
  * @param reachedAt since when the vehicle is at that item
  * @param sender system number of the peer that uploaded it
  */
final case class Mission(
    items: Vector[MissionItemInt] = Vector.empty,
    current: Int = 0,
    reachedAt: Option[Span] = None,
    sender: Option[Int] = None
):
  def isOver: Boolean              = current >= items.size
  def item: Option[MissionItemInt] = items.lift(current)
  def next: Mission                = copy(current = current + 1, reachedAt = None)
  def from(seq: Int): Mission      = copy(current = seq, reachedAt = None)

  def told: Message = MissionCurrent((current.min(items.size - 1)).max(0), items.size)

object Mission:
  val Most = 1000

  /** The mission type of missions; fences and rally points, the other types, are not supported. */
  val Kind = 0

  /** Results in acknowledgements (`MAV_MISSION_RESULT`). */
  object Ack:
    val Accepted         = 0
    val Failed           = 1
    val UnsupportedFrame = 2
    val Unsupported      = 3
    val NoSpace          = 4
    val Invalid          = 5
    val OutOfOrder       = 13
    val Cancelled        = 15

  /** Maximum distance of an item from home, m: a mission beyond it belongs to another home. Far more than any
    * mission needs, and less than the distance to another town.
    */
  val FarthestM = 20_000.0

  /** The refusal of an item: the acknowledgement's result, and lines of at most 50 characters. None if the
    * item is accepted.
    */
  def mistake(item: MissionItemInt, home: GeoLocation): Option[(Int, Vector[String])] =
    import CommonDialect.Command.*
    import CommonDialect.Frame
    val places  = Set(Waypoint, LoiterUnlimited, LoiterTime, Land, Takeoff)
    val others  = Set(ReturnToLaunch, Delay, ChangeSpeed)
    val isPlace = places(item.command)
    val frames  = Set(Frame.Global, Frame.GlobalInt, Frame.RelativeAltitude, Frame.RelativeAltitudeI)
    if !isPlace && !others(item.command) then
      Some((Ack.Unsupported, Vector(s"mission item ${item.seq}: command ${item.command} unsupported")))
    else if isPlace && !frames(item.frame) then
      Some((Ack.UnsupportedFrame, Vector(s"mission item ${item.seq}: frame ${item.frame} unsupported")))
    else if Set(Delay, LoiterTime)(item.command) && !item.param1.isFinite then
      Some((Ack.Invalid, Vector(s"mission item ${item.seq}: its time is no number")))
    else if isPlace && !(item.z.isFinite && item.z.abs < 1e5) then
      Some((Ack.Invalid, Vector(s"mission item ${item.seq}: altitude is no number")))
    else if isPlace && !(item.x.abs <= 900_000_000 && item.y.abs <= 1_800_000_000) then
      Some((Ack.Invalid, Vector(s"mission item ${item.seq}: no place on the globe")))
    else if isPlace && !isHere(item) then
      val away = OffboardSetpoint.awayM(item.x * 1e-7, item.y * 1e-7, home)
      Option.when(away > FarthestM)((
        Ack.Invalid,
        s"mission item ${item.seq}: ${(away / 1000).fixed(0)} km from home, at most ${(FarthestM / 1000).toInt}" +:
          OffboardSetpoint.whereHomeIs(home)
      ))
    else None

  private def isHere(item: MissionItemInt) = item.x == 0 && item.y == 0

  /** An item's position in the vehicle's own frame; latitude and longitude of 0 mean the current position. */
  def place(item: MissionItemInt, home: GeoLocation, hereNed: Vector3): Vector3 =
    val altitude = OffboardSetpoint.heightOf(item.frame, item.z, home).getOrElse(home.altitude)
    val at       = GeoLocation(item.x * 1e-7, item.y * 1e-7, altitude).nedFrom(home)
    if isHere(item) then hereNed.copy(z = at.z) else at
