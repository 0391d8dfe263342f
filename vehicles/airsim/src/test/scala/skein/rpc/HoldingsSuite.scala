package skein.rpc

import scala.util.Random

class HoldingsSuite extends munit.FunSuite:

  test("a connection may always hold its own part, and more while the common part suffices"):
    val holdings = Holdings(each = 10, common = 100)
    val greedy   = holdings.Holding()
    val modest   = holdings.Holding()
    assert(greedy.resize(110))
    assert(!greedy.resize(111))
    assert(modest.resize(10))
    assert(!modest.resize(11))
    assertEquals(holdings.bytes, 120L)
    assert(greedy.resize(60))
    assert(modest.resize(60))
    assert(greedy.resize(0) && modest.resize(0))
    assertEquals((holdings.bytes, holdings.mostBytes), (0L, 120L))

  test("forced bytes are held even if not granted, and are given back"):
    val holdings = Holdings(each = 10, common = 5)
    val one      = holdings.Holding()
    one.force(50)
    assert(!holdings.Holding().resize(11))
    assert(one.resize(50) && !one.isGranted)
    assert(one.resize(16) && !one.isGranted)
    assert(one.resize(15) && one.isGranted)
    one.force(16)
    val other = holdings.Holding()
    assert(!one.isGranted && other.resize(10))
    assert(one.resize(15) && one.isGranted)
    one.force(0)
    assert(holdings.Holding().resize(15))

  test("for any requests the total never exceeds the common part and all own parts"):
    for seed <- 1 to 100 do
      val random   = Random(seed)
      val holdings = Holdings(each = 10, common = 50)
      val all      = Vector.fill(8)(holdings.Holding())
      for _ <- 1 to 500 do
        val _ = all(random.nextInt(all.size)).resize(random.nextInt(60))
      assert(holdings.mostBytes <= 50 + 8 * 10, s"seed $seed")
      all.foreach(_.force(0))
      assertEquals(holdings.bytes, 0L, s"seed $seed")

  test("forced bytes are granted once all connections together hold exactly the common part"):
    val holdings   = Holdings(each = 10, common = 5)
    val (one, two) = (holdings.Holding(), holdings.Holding())
    assert(two.resize(12))
    one.force(15)
    assert(!one.isGranted)
    assert(two.resize(10))
    assert(one.isGranted)
