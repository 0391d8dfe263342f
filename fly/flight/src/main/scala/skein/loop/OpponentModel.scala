package skein.loop

import skein.planning.Planner
import skein.policy.{Agent, Fleet, Policy}

/** A plan's model of the opponent of a vehicle that plays against one. */
object OpponentModel:

  /** The assumed policy of an opponent, or why it is assumed to fly straight on. */
  private[loop] def of(opponent: Agent): Either[String, Policy] =
    if !opponent.policy.isAgainstOne then Left("it plays against more than one vehicle")
    else
      val policy = opponent.policy.guessed(_ => 0)
      Planner.refusal(policy).toLeft(policy)

  /** The vehicles whose decisions plans may predict, by their indices. */
  private[loop] def known(fleet: Fleet): Vector[Int] =
    fleet.agents.indices.toVector.filter(vehicle => of(fleet.agents(vehicle)).isRight)

  /** The vehicles that decide by what plans do not know, in a line each for the user. */
  def missing(fleet: Fleet): Vector[String] =
    val duellists =
      fleet.agents.filter(agent => Planning.plans(agent) && agent.policy.isAgainstOne)
    for
      other   <- fleet.agents if duellists.exists(_.role != other.role)
      instead <- of(other) match
        case Left(reason)                               => Some(s"taken to fly straight on: $reason")
        case Right(policy) if Planner.remembers(policy) =>
          Some("predicted as if it had just begun: plans do not know its policy's memory")
        case _ => None
    yield s"plan: ${other.name} is $instead"
