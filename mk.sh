cd /work/wt-spread && nice -n 10 timeout 580 ninja -C build -j2 solver 2>&1 | grep -E "error|warning|FAILED|note:" | head -30
g++ -O1 -std=c++20 -I/work/wt-spread /tmp/spread/sp.cpp build/libsolver.a build/libstats.a build/libsolver.a -o /tmp/spread/${1:-sp}
