package skein.lanes

import skein.forward.Delays

/** The worlds of one call, numbered from 0. All methods are pure functions, and may be called from any
  * thread.
  *
  * Neighbouring worlds that share a link should return the identical object, because its delays are then
  * copied into the first-level cache only once. Otherwise the order of worlds is free.
  */
trait Worlds:
  def size: Int

  /** Whether several worlds have equal keys and links, as candidates with shared episodes do. They are then
    * simulated together by one [[skein.lanes.timetable.Timetable]], several times as fast.
    */
  def shareEpisodes: Boolean = false

  /** Number of episodes if all candidates share them, else 0. A world's number is then candidate · episodes +
    * episode; the candidate alone determines the policies, and the episode alone determines key and link.
    * Only such worlds run on a GPU.
    */
  def episodesOfEach: Int = 0

  /** The world's `skein.simd.WorldRandom.key`, which determines all its delays over a link. */
  def key(world: Int): Int
  def link(world: Int): Delays
