package skein.autopilot

import skein.mavlink.*
import skein.mavlink.CommonDialect.Severity
import skein.units.*

/** Upload and download of missions by MAVLink's mission protocol, as a value: messages go in, the vehicle's
  * mission and the answers come out.
  *
  * @param mission the vehicle's mission
  * @param upload the upload of a new mission, which replaces this one once all its items are received
  * @param home the vehicle's home: items must be near it
  */
private[autopilot] final case class MissionTransfer(
    mission: Mission,
    upload: Option[Upload],
    home: GeoLocation
):
  import MissionTransfer.Told
  import Autopilot.text

  /** @param from system and component of the sender
    * @return None if the message does not belong to the protocol
    */
  def heard(message: Message, from: (system: Int, component: Int), sinceBoot: Span): Option[Told] =
    message match
      case MissionRequestList(_, _, kind) =>
        val count = if kind == Mission.Kind then mission.items.size else 0
        Some(Told(this, Vector(MissionCount(from.system, from.component, count, kind))))
      case MissionRequestInt(_, _, seq, Mission.Kind) => Some(Told(this, Vector(item(seq, from))))
      case MissionCount(_, _, count, kind)            => Some(begin(count, kind, from, sinceBoot))
      case item: MissionItemInt                       => Some(receive(item, from, sinceBoot))
      case MissionClearAll(_, _, kind)                =>
        val cleared = if kind == Mission.Kind then MissionTransfer(Mission(), None, home) else this
        Some(Told(cleared, Vector(ack(from, Mission.Ack.Accepted, kind))))
      case _ => None

  /** Advances time, and requests again an item that has not been received. */
  def passed(sinceBoot: Span): Told = upload match
    case Some(going) if sinceBoot - going.askedAt >= Upload.AskAgain =>
      if going.tries >= Upload.MostTries then
        Told(
          copy(upload = None),
          news = Vector(going.ack(Mission.Ack.Cancelled), text(Severity.Warning, "mission: upload given up"))
        )
      else
        val again = going.copy(askedAt = sinceBoot, tries = going.tries + 1)
        Told(copy(upload = Some(again)), news = Vector(again.question))
    case _ => Told(this)

  private def ack(to: (system: Int, component: Int), result: Int, kind: Int = Mission.Kind) =
    MissionAck(to.system, to.component, result, kind)

  private def item(seq: Int, to: (system: Int, component: Int)): Message = mission.items.lift(seq) match
    case Some(item) => item.copy(targetSystem = to.system, targetComponent = to.component, seq = seq)
    case None       => ack(to, Mission.Ack.OutOfOrder)

  private def begin(
      count: Int,
      kind: Int,
      from: (system: Int, component: Int),
      sinceBoot: Span
  ): Told =
    def answer(result: Int) = Vector(ack(from, result, kind))
    if kind != Mission.Kind then Told(this, answer(Mission.Ack.Unsupported))
    else if count > Mission.Most then
      val why = text(Severity.Critical, s"mission: at most ${Mission.Most} items")
      Told(this, answer(Mission.Ack.NoSpace), Vector(why))
    else if count == 0 then Told(MissionTransfer(Mission(), None, home), answer(Mission.Ack.Accepted))
    else
      val begun = Upload(from.system, from.component, count, Vector.empty, sinceBoot, tries = 1)
      Told(copy(upload = Some(begun)), Vector(begun.question))

  private def receive(item: MissionItemInt, from: (system: Int, component: Int), sinceBoot: Span): Told =
    upload match
      case Some(going) if going.system == from.system && item.missionType == Mission.Kind =>
        if item.seq != going.items.size then Told(this, Vector(going.question))
        else
          Mission.mistake(item, home) match
            case Some((result, why)) =>
              Told(
                copy(upload = None),
                Vector(going.ack(result)),
                why.map(text(Severity.Critical, _))
              )
            case None =>
              val more = going.copy(items = going.items :+ item, askedAt = sinceBoot, tries = 1)
              if more.items.size < more.count then Told(copy(upload = Some(more)), Vector(more.question))
              else
                val loaded = Mission(more.items, sender = Some(going.system))
                Told(MissionTransfer(loaded, None, home), Vector(more.ack(Mission.Ack.Accepted)))
      // The acknowledgement was lost.
      case None
          if mission.sender.contains(from.system) && item.seq == mission.items.size - 1 &&
            item.missionType == Mission.Kind =>
        Told(this, Vector(ack(from, Mission.Ack.Accepted)))
      case _ => Told(this, Vector(ack(from, Mission.Ack.OutOfOrder)))

private[autopilot] object MissionTransfer:
  /** The result of a message.
    *
    * @param answers messages to the sender
    * @param news messages to every peer
    */
  final case class Told(
      next: MissionTransfer,
      answers: Vector[Message] = Vector.empty,
      news: Vector[Message] = Vector.empty
  )

/** A mission being uploaded: items are requested one by one, and again if they are not received.
  *
  * @param system the sender's system number
  * @param askedAt when the next item was last requested
  */
final case class Upload(
    system: Int,
    component: Int,
    count: Int,
    items: Vector[MissionItemInt],
    askedAt: Span,
    tries: Int
):
  def question: Message       = MissionRequestInt(system, component, items.size)
  def ack(kind: Int): Message = MissionAck(system, component, kind)

object Upload:
  val AskAgain: Span = Span.ofMillis(250)
  val MostTries      = 10
