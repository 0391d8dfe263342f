package skein.view

import skein.units.Instant

class PlaybackSuite extends munit.FunSuite:
  private def at(seconds: Double) = Instant.ofNanos((seconds * 1e9).toLong)
  private val standing            = Playback(at(100), at(160))

  test("playback is stopped at the start until it is played"):
    assertEquals(standing.position(at(5)), at(100))

  test("playback runs at its speed, stays where it is stopped, and stops at the end"):
    val fast = standing.controlled(playing = true, 2, None, at(5))
    assertEquals(fast.position(at(15)), at(120))
    val stopped = fast.controlled(playing = false, 2, None, at(15))
    assertEquals(stopped.position(at(99)), at(120))
    assertEquals(fast.position(at(35)), at(160))
    assertEquals(fast.position(at(1e6)), at(160))
    assert(!fast.hasEnded(at(34.9)) && fast.hasEnded(at(35)))

  test("a change of speed continues from the current position"):
    val slower =
      standing.controlled(playing = true, 10, None, at(0)).controlled(playing = true, 0.5, None, at(2))
    assertEquals(slower.position(at(12)), at(125))

  test("playback seeks to any time of the recording, and clamps times outside it"):
    assertEquals(standing.controlled(playing = false, 1, Some(at(130)), at(7)).position(at(8)), at(130))
    assertEquals(standing.controlled(playing = true, 1, Some(at(0)), at(7)).position(at(7)), at(100))
    assertEquals(standing.controlled(playing = true, 1, Some(at(1e6)), at(7)).position(at(7)), at(160))

  test("playing from the end starts again from the beginning"):
    val ended = standing.controlled(playing = true, 1, None, at(0))
    assertEquals(ended.controlled(playing = true, 1, None, at(70)).position(at(71)), at(101))

  test("a clock that runs backwards does not play backwards"):
    assertEquals(standing.controlled(playing = true, 1, None, at(10)).position(at(9)), at(100))
