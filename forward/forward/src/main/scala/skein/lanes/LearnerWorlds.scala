package skein.lanes

import skein.lanes.timetable.TimetableKernel

/** Worlds of one team that stop whenever learners are to decide. Indices of learners and scores follow the
  * order in which the worlds were given them. Mutable; one thread at a time.
  */
trait LearnerWorlds extends AutoCloseable:
  /** Whether a world can be restarted while the others go on. */
  def restartAlone: Boolean

  /** Begins a run without simulating anything; [[restart]] sets the vehicles' starts.
    *
    * @param draw index of the run's sequence of delays
    * @param untilS time of the last score that counts
    */
  def start(draw: Long, untilS: Float): Unit

  /** Restarts a vehicle in one world: it rests at this position, also in pending readings, and its previous
    * commands were along this heading. Pending requests and commands stay, as in a loop that runs already.
    */
  def restart(world: Int, vehicle: Int, northM: Float, eastM: Float, headingRad: Float): Unit

  /** Simulates until learners are to decide; false at the end of the run. */
  def flyOn(): Boolean

  def isDue(learner: Int): Boolean

  /** Writes what a learner that is due observes: a row of [[LearnerWorlds.Most]] worlds for each component.
    */
  def observe(learner: Int, into: Array[Float]): Unit

  /** Sets a component of the action of a learner that is due, by world; see [[LearnerPolicy]]. */
  def act(learner: Int, component: Int, numbers: Array[Float]): Unit

  def decide(): Unit

  /** Whether, since a world's restart, the scenario has ended there by its own end condition. */
  def hasEnded(world: Int): Boolean

  /** Time of the last score, since the run's start, s. */
  def scoredAtS: Float

  /** Writes a score for each world, since [[forgetScores]]: the newest or minimum value, or the sum of all.
    */
  def soFar(number: Int, into: Array[Float]): Unit

  /** Discards all scores except the newest values. */
  def forgetScores(): Unit

  /** Discards one world's scores except the newest values, after a restart of that world. */
  def forgetScores(world: Int): Unit

  def close(): Unit = ()

object LearnerWorlds:
  /** Maximum number of worlds that are simulated together. */
  val Most: Int = TimetableKernel.WORLDS
