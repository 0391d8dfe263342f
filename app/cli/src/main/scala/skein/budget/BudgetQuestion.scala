package skein.budget

import skein.lanes.Engine
import skein.optimise.Objective
import skein.pickle.Fields
import skein.policy.Role
import skein.scenario.Scenarios
import skein.search.{Conditions, Effort}
import skein.settings.{PolicyFile, ScenarioSettings}
import upickle.default.ReadWriter

/** A budget's question in the user's words: enough for another process to simulate identical episodes. */
sealed trait BudgetQuestion:
  /** Resolves the question.
    *
    * @return Left says what was expected, what was given, and in which option
    */
  def subject(threads: Int)(using Scenarios): Either[String, BudgetSubject]

object BudgetQuestion:
  given ReadWriter[BudgetQuestion] = Fields.ofCases

  /** A question about a policy in the paper's duel.
    *
    * @param policy the policy as [[PolicyFile.text]] writes it; likewise `opponent`
    * @param role the policy's role
    */
  final case class OfDuel(
      role: String,
      policy: String,
      opponent: String,
      objective: String,
      conditions: Conditions,
      seed: Long
  ) extends BudgetQuestion:
    def subject(threads: Int)(using Scenarios): Either[String, BudgetSubject] =
      for
        role      <- PolicyFile.role(role)
        policy    <- PolicyFile.parse(role, policy).left.map("--policy: " + _)
        opponent  <- PolicyFile.parse(Role.opponentOf(role), opponent).left.map("--opponent: " + _)
        objective <- Objective.ofRole(objective, role).left.map("--objective: " + _)
        flown     <- conditions.resolved
      yield
        def pair(of: Conditions.Resolved) =
          of.game.flownBy(role, policy.policy).flownBy(opponent.role, opponent.policy)
        def effort(alone: Engine) = Effort.of(alone, alone, flown.vehicle, flown.sees)
        TeamSubject(
          conditions,
          flown,
          policy.label,
          pair(flown),
          pair(flown.paused),
          objective,
          effort,
          seed,
          threads
        )

  /** A question about a scenario.
    *
    * @param set settings by their keys
    * @param objective a sum of its measures; without one, the first
    */
  final case class OfScenario(
      scenario: String,
      set: Map[String, String],
      objective: Option[String],
      conditions: Conditions,
      plantIsTold: Boolean,
      seed: Long
  ) extends BudgetQuestion:
    def subject(threads: Int)(using scenarios: Scenarios): Either[String, BudgetSubject] =
      for
        kind    <- scenarios.kind(scenario).left.map("--scenario: " + _)
        stated  <- ScenarioSettings.ofKeys(kind, set).left.map("--set: " + _)
        asked   <- ScenarioQuestion.of(stated, objective, conditions, seed, threads)
        subject <- asked.subject(plantIsTold)
      yield subject
