package skein.link

import skein.units.{Instant, Span}

/** Who has one of a port's places, and who gives up a place to one who comes when all are taken. Immutable.
  *
  * First go those who have never said anything of use, the oldest of them; then those who have been silent,
  * the longest silent. Where nobody has been idle for long enough, who comes gets no place. So connections
  * that stay silent, send a message a byte at a time, or say one word and wait lock nobody out.
  *
  * @param most places, at least one
  * @param guests who has one, by a name of the caller's
  * @tparam K names guests
  */
final case class Places[K] private (most: Int, guests: Map[K, Places.Guest]):
  import Places.*

  /** One more comes. Costs a look at all guests where all places are taken. */
  def entered(guest: K, now: Instant): Entry[K] =
    if guests.sizeIs < most then Entry.Free(copy(guests = guests.updated(guest, Guest(now, None))))
    else
      idlest(now) match
        case None        => Entry.Full()
        case Some(other) =>
          Entry.InPlaceOf(other, copy(guests = (guests - other).updated(guest, Guest(now, None))))

  /** A guest has said something of use; nothing where it has no place any more. */
  def spoke(guest: K, now: Instant): Places[K] =
    copy(guests = guests.updatedWith(guest)(_.map(_.copy(spokeAt = Some(now)))))

  def left(guest: K): Places[K] = copy(guests = guests - guest)

  private def idlest(now: Instant): Option[K] =
    val (silent, speaking) = guests.partition((_, guest) => guest.spokeAt.isEmpty)
    silent.minByOption(_._2.cameAt).filter((_, guest) => now.since(guest.cameAt) >= Unspoken)
      .orElse(speaking.minByOption(_._2.spokeAt).filter((_, guest) =>
        guest.spokeAt.forall(now.since(_) >= Silent)
      ))
      .map(_._1)

object Places:
  /** So long a connection may take to say its first word before one who comes may have its place. */
  val Unspoken: Span = Span.ofSeconds(1)

  /** So long it may be silent after that. */
  val Silent: Span = Span.ofSeconds(5)

  /** @param spokeAt when it last said something of use, if ever
    */
  final case class Guest(cameAt: Instant, spokeAt: Option[Instant])

  enum Entry[K]:
    case Free(places: Places[K])

    /** `other` is to go. */
    case InPlaceOf(other: K, places: Places[K])

    /** All are taken by those who use theirs. */
    case Full()

  def of[K](most: Int): Places[K] =
    require(most > 0, s"expected at least one place, got $most")
    Places(most, Map.empty)
