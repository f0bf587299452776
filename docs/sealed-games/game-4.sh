mgt-rig table --rig table6 --seed 179595 --hide 2 --seal game-4.sealed -o game-4.csv
