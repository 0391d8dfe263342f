"""asyncio: a coroutine flies, another takes large pictures, each with a client of its own on a thread of its own."""

import asyncio
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import airsim

import inside

port, seconds = int(sys.argv[1]), float(sys.argv[2])
until = time.monotonic() + seconds


async def fly():
    with ThreadPoolExecutor(1) as own:
        loop = asyncio.get_running_loop()
        client = await loop.run_in_executor(own, lambda: airsim.MultirotorClient(port=port))

        def step():
            state = client.getMultirotorState("Evader1")
            inside.commanded(state)
            client.moveByVelocityZAsync(3, 0, -20, 5, vehicle_name="Evader1")

        while time.monotonic() < until:
            await loop.run_in_executor(own, step)
            await asyncio.sleep(0.03)
        await loop.run_in_executor(own, lambda: client.hoverAsync("Evader1").join())


async def look():
    with ThreadPoolExecutor(1) as own:
        loop = asyncio.get_running_loop()
        client = await loop.run_in_executor(own, lambda: airsim.MultirotorClient(port=port))
        wanted = [airsim.ImageRequest("0", airsim.ImageType.Scene, False, False)] * 6
        while time.monotonic() < until:
            await loop.run_in_executor(own, client.simGetImages, wanted, "Evader1")
            await asyncio.sleep(0.3)


async def main():
    await asyncio.gather(fly(), look())


asyncio.run(main())
inside.told()
