package skein.link

import java.util.concurrent.locks.LockSupport

/** How late a thread runs that wakes every 17 ms or so, beside another that works 3 of every 10 ms on the same processor:
  * first with the slices that Linux gives, then with [[TimeSlice.shorten]]. The processor must be the only one, as by
  * `taskset -c 0 ./sbtw "link/Test/runMain skein.link.wakingBesideWork 1000"`.
  */
@main def wakingBesideWork(wakes: Int): Unit =
  def spin(nanos: Long): Unit =
    val until = System.nanoTime() + nanos
    while System.nanoTime() < until do Thread.onSpinWait()

  def late(isShort: Boolean): Unit =
    val measuring = Thread: () =>
      if isShort then println(s"slices: ${TimeSlice.shorten()}")
      @volatile var on = true
      val working      = Thread.ofPlatform.start: () =>
        while on do
          spin(3_000_000)
          LockSupport.parkNanos(7_000_000)
      val lateMs = (1 to wakes).map: wake =>
        val due = System.nanoTime() + 17_000_000 + wake * 137_000 % 1_000_000
        while due > System.nanoTime() do LockSupport.parkNanos(due - System.nanoTime())
        (System.nanoTime() - due) * 1e-6
      on = false
      working.join()
      val sorted                  = lateMs.sorted
      def quantile(share: Double) = sorted(((wakes - 1) * share).round.toInt)
      println(
        f"late p50 ${quantile(0.5)}%.2f, p90 ${quantile(0.9)}%.2f, p99 ${quantile(0.99)}%.2f, most ${sorted.last}%.2f ms"
      )
    measuring.start()
    measuring.join()

  late(isShort = false)
  late(isShort = true)
