package skein.view

/** One viewer's subscriptions by channel. */
final case class Subscriptions private (limits: ViewerLimits, channels: Set[Long], chosen: Map[Long, Long]):

  def of(channel: Long): Iterable[Long] = byChannel.getOrElse(channel, Nil)

  private lazy val byChannel: Map[Long, Iterable[Long]] =
    chosen.groupMap((_, channel) => channel)((subscription, _) => subscription)

  /** @return Left says why it is refused */
  def added(subscription: Long, channel: Long): Either[String, Subscriptions] =
    if !channels(channel) then Left(s"there is no channel $channel")
    else if chosen.contains(subscription) then Left(s"there is a subscription $subscription already")
    else if chosen.size >= limits.subscriptions then
      Left(s"a viewer has at most ${limits.subscriptions} subscriptions")
    else Right(copy(chosen = chosen.updated(subscription, channel)))

  def removed(subscription: Long): Either[String, Subscriptions] =
    Either.cond(
      chosen.contains(subscription),
      copy(chosen = chosen - subscription),
      s"there is no subscription $subscription"
    )

object Subscriptions:
  def none(limits: ViewerLimits, channels: Set[Long]): Subscriptions =
    Subscriptions(limits, channels, Map.empty)
